// OBJ: lines `v x y z` and `f a b c ...`; all else is left out.
#include <charconv>
#include <string_view>

#include "geometry/status.hpp"
#include "mesh_files/formats.hpp"
#include "mesh_files/number_from.hpp"

namespace tensegric_fit::mesh_files {
namespace {

namespace refusal = geometry::refusal;
using geometry::Refusal;

/// Words of a file, line by line; after a backslash at its end a line of numbers continues on the next.
/// Others do not: the path that a comment or a library names may end in one.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next() {
    if (rest_.empty()) return false;
    const std::size_t first = rest_.find_first_not_of(" \t\r");
    const bool is_numbers = first != std::string_view::npos && (rest_[first] == 'v' || rest_[first] == 'f');
    std::size_t end = rest_.find('\n');
    while (is_numbers && end != std::string_view::npos && end > 0 &&
           (rest_[end - 1] == '\\' || (end > 1 && rest_[end - 1] == '\r' && rest_[end - 2] == '\\')))
      end = rest_.find('\n', end + 1);
    line_ = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
    ++number_;
    return true;
  }

  // Empty at the line's end.
  std::string_view word() {
    constexpr std::string_view kBlank = " \t\r\n\\";
    const std::size_t start = line_.find_first_not_of(kBlank);
    if (start == std::string_view::npos) return {};
    line_ = line_.substr(start);
    const std::size_t end = std::min(line_.find_first_of(kBlank), line_.size());
    const std::string_view result = line_.substr(0, end);
    line_ = line_.substr(end);
    return result;
  }

  std::string where(const std::string& path) const { return path + ": line " + std::to_string(number_); }

 private:
  std::string_view rest_, line_;
  std::size_t number_ = 0;
};

Eigen::Vector3d vertex_from(Lines& lines, const std::string& path) {
  Eigen::Vector3d p;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view word = lines.word();
    const auto [end, error] = number_from(word.data(), word.data() + word.size(), p[axis]);
    if (word.empty() || error != std::errc() || end != word.data() + word.size())
      throw Refusal(refusal::kBrokenFile, lines.where(path) + " has no three coordinates");
  }
  if (!p.allFinite())
    throw Refusal(refusal::kNonFinite, lines.where(path) + " has a coordinate that is not finite");
  return p;
}

// From 1, or from the newest backwards: -1 is the newest.
int index_from(std::string_view word, std::size_t vertices, const Lines& lines, const std::string& path) {
  long long index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool whole = end == word.data() + word.size() || (end != word.data() && *end == '/');
  if (error == std::errc::invalid_argument || !whole)
    throw Refusal(refusal::kBrokenFile,
                  lines.where(path) + ": '" + std::string(word.substr(0, 40)) + "' is no corner of a face");
  const auto count = static_cast<long long>(vertices);
  if (error != std::errc() || index == 0 || index > count || index < -count)
    throw Refusal(refusal::kBadMesh, lines.where(path) + " has a face with a vertex that is not there: " +
                                         std::string(word.substr(0, 40)));
  return static_cast<int>(index > 0 ? index - 1 : count + index);
}

}  // namespace

geometry::TriangleMesh obj_mesh(const std::string& bytes, const std::string& path) {
  geometry::TriangleMesh mesh;
  for (Lines lines(without_mark(bytes)); lines.next();) {
    const std::string_view key = lines.word();
    if (key == "v") mesh.vertices.push_back(vertex_from(lines, path));
    if (key == "f") {
      int corners = 0, first = 0, last = 0;
      for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
        const int corner = index_from(word, mesh.vertices.size(), lines, path);
        if (++corners == 1) first = corner;
        if (corners >= 3) mesh.triangles.emplace_back(first, last, corner);
        last = corner;
        check_count(0, mesh.triangles.size(), path);
      }
    }
    check_count(mesh.vertices.size(), 0, path);
  }
  return mesh;
}

}  // namespace tensegric_fit::mesh_files
