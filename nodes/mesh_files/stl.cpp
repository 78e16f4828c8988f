// STL, binary and ASCII. The file's length says which: binary files often begin with "solid", too. Each facet
// has three corners of its own, which read_mesh() joins and counts then: here the facets are counted.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "geometry/status.hpp"
#include "mesh_files/formats.hpp"
#include "mesh_files/number_from.hpp"

namespace tensegric_fit::mesh_files {
namespace {

namespace refusal = geometry::refusal;
using geometry::Refusal;

constexpr std::size_t kHeader = 84, kFacet = 50;

geometry::TriangleMesh binary(const std::string& bytes, std::size_t count, const std::string& path) {
  check_count(0, count, path);
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  for (std::size_t f = 0; f < count; ++f) {
    for (int c = 0; c < 3; ++c) {
      Eigen::Vector3f p;
      std::memcpy(p.data(), bytes.data() + kHeader + kFacet * f + 12 + 12 * c, 12);
      mesh.vertices.emplace_back(p.cast<double>());
    }
    const int v = static_cast<int>(3 * f);
    mesh.triangles.emplace_back(v, v + 1, v + 2);
  }
  return mesh;
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return lower;
}

geometry::TriangleMesh ascii(std::string_view rest, const std::string& path) {
  const Refusal broken(refusal::kBrokenFile, path + ": a facet of this ASCII STL has no three corners");
  constexpr std::string_view kBlank = " \t\r\n", kCorner = "vertex";
  const auto word = [&]() -> std::string_view {
    const std::size_t start = rest.find_first_not_of(kBlank);
    if (start == std::string_view::npos) return {};
    const std::size_t end = std::min(rest.find_first_of(kBlank, start), rest.size());
    const std::string_view result = rest.substr(start, end - start);
    rest = rest.substr(end);
    return result;
  };
  std::size_t most = 0;  // corners
  for (std::size_t at = rest.find(kCorner); at != std::string_view::npos;
       at = rest.find(kCorner, at + kCorner.size()))
    ++most;
  check_count(0, most / 3, path);
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(most);
  mesh.triangles.reserve(most / 3);
  int corners = 0;
  for (std::string_view w = word(); !w.empty(); w = word()) {
    if (w == "solid" || w == "endsolid") {
      const std::string_view name = rest.substr(0, rest.find_first_of("\r\n"));
      if (name.find("normal") == std::string_view::npos)  // else the facets stand on the same line
        rest = rest.substr(name.size());
    }
    if (w == "endfacet" && corners != 3) throw broken;
    if (w == "facet") corners = 0;
    if (w != kCorner) continue;
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view number = word();
      const auto [end, error] = number_from(number.data(), number.data() + number.size(), p[axis]);
      if (number.empty() || error != std::errc() || end != number.data() + number.size()) throw broken;
    }
    mesh.vertices.push_back(p);
    if (++corners > 3) throw broken;
    const int v = static_cast<int>(mesh.vertices.size());
    if (corners == 3) mesh.triangles.emplace_back(v - 3, v - 2, v - 1);
  }
  if (mesh.vertices.size() != 3 * mesh.triangles.size()) throw broken;
  return mesh;
}

}  // namespace

geometry::TriangleMesh stl_mesh(const std::string& bytes, const std::string& path) {
  if (bytes.size() >= kHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    if (bytes.size() == kHeader + kFacet * static_cast<std::size_t>(count)) return binary(bytes, count, path);
  }
  std::string_view text = without_mark(bytes);
  text = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const bool says_ascii = in_lower_case(text.substr(0, 5)) == "solid";
  const bool is_text = text.find('\0') == std::string_view::npos;
  if (says_ascii && is_text) return ascii(in_lower_case(text), path);
  throw Refusal(
      refusal::kBrokenFile,
      path + (says_ascii ? ": says that it is ASCII STL and is binary, of another length than it says"
                         : ": is not STL, or binary STL of another length than its number of facets says"));
}

}  // namespace tensegric_fit::mesh_files
