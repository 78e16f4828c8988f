#include "mesh_files/read_mesh.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string_view>
#include <tuple>
#include <utility>

#include "geometry/status.hpp"
#include "mesh_files/formats.hpp"
#include "mesh_files/number_from.hpp"

namespace tensegric_fit::mesh_files {
namespace {

namespace refusal = geometry::refusal;
using geometry::Refusal;
using geometry::TriangleMesh;

std::string bytes_of(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none))
    throw Refusal(refusal::kBrokenFile, path + ": does not exist or is no regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  if (none) throw Refusal(refusal::kBrokenFile, path + ": cannot be read");
  if (size > kMostBytes)
    throw Refusal(refusal::kTooManyPoints, path + ": has " + std::to_string(size >> 20) +
                                               " MB; mesh files of up to " +
                                               std::to_string(kMostBytes >> 20) + " MB are read");
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw Refusal(refusal::kBrokenFile, path + ": cannot be read");
  return bytes;
}

// For each vertex the first one in its place.
std::vector<int> first_in_place(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<int> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int v) {  // what is not finite comes last, each its own place
    const bool finite = vertices[v].allFinite();
    const Eigen::Vector3d p = finite ? vertices[v] : Eigen::Vector3d::Zero();
    return std::tuple(!finite, p.x(), p.y(), p.z(), v);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

// Each vertex is the first one in its place.
TriangleMesh joined(TriangleMesh mesh, const std::vector<int>& first) {
  std::vector<Eigen::Vector3i>& triangles = mesh.triangles;
  for (Eigen::Vector3i& t : triangles) t = Eigen::Vector3i(first[t[0]], first[t[1]], first[t[2]]);
  const auto lacks_a_corner = [](const Eigen::Vector3i& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), lacks_a_corner), triangles.end());
  return geometry::submesh(mesh, std::vector<char>(triangles.size(), 1));
}

std::string in_words(std::size_t count) {
  constexpr std::size_t kMillion = 1'000'000;
  return count % kMillion == 0 ? std::to_string(count / kMillion) + " million" : std::to_string(count);
}

void check_against(std::size_t most_vertices, std::size_t vertices, std::size_t triangles,
                   const std::string& path) {
  if (vertices <= most_vertices && triangles <= kMostTriangles) return;
  throw Refusal(refusal::kTooManyPoints, path + ": has more than " + in_words(most_vertices) +
                                             " vertices or " + in_words(kMostTriangles) + " triangles");
}

/// "0,12 1,5 0,7": three numbers with a comma each and blanks between them.
bool has_decimal_commas(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r;";
  for (int axis = 0; axis < 3; ++axis) {
    line = line.substr(std::min(line.find_first_not_of(kBetween), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBetween));
    const std::size_t comma = word.find(',');
    const auto is_digit = [&word](std::size_t at) {
      return at < word.size() && std::isdigit(static_cast<unsigned char>(word[at])) != 0;
    };
    if (comma == 0 || comma == std::string_view::npos || !is_digit(comma - 1) || !is_digit(comma + 1) ||
        word.find(',', comma + 1) != std::string_view::npos)
      return false;
    line = line.substr(word.size());
  }
  return true;
}

}  // namespace

TriangleMesh tidy(TriangleMesh mesh) {
  const std::vector<int> first = first_in_place(mesh.vertices);
  return joined(std::move(mesh), first);
}

TriangleMesh checked_and_tidy(TriangleMesh mesh, const std::string& path, std::size_t most_vertices) {
  if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const auto& p) { return p.allFinite(); }))
    throw Refusal(refusal::kNonFinite, path + ": has a coordinate that is not finite");
  const int count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (t.minCoeff() < 0 || t.maxCoeff() >= count)
      throw Refusal(refusal::kBadMesh, path + ": has a face with a vertex that is not there");
  const std::vector<int> first = first_in_place(mesh.vertices);
  std::size_t places = 0;
  for (int v = 0; v < count; ++v) places += first[v] == v ? 1 : 0;
  check_against(most_vertices, places, mesh.triangles.size(), path);
  TriangleMesh result = joined(std::move(mesh), first);
  if (result.triangles.empty()) throw Refusal(refusal::kBadMesh, path + ": has no faces");
  return result;
}

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

bool is_mesh_name(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".obj" || ending == ".stl" || ending == ".glb" || ending == ".gltf";
}

void check_count(std::size_t vertices, std::size_t triangles, const std::string& path) {
  check_against(kMostVertices, vertices, triangles, path);
}

TriangleMesh read_mesh(const std::string& path) {
  const std::string ending = ending_of(path);
  if (!is_mesh_name(path))
    throw Refusal(refusal::kBadOption, path + ": a mesh file ends in .obj, .stl, .glb or .gltf");
  const auto reader = ending == ".obj"   ? obj_mesh
                      : ending == ".stl" ? stl_mesh
                      : ending == ".glb" ? glb_mesh
                                         : gltf_mesh;
  TriangleMesh mesh = reader(bytes_of(path), path);  // the file's bytes are not held any longer than this
  return checked_and_tidy(std::move(mesh), path);
}

std::vector<Eigen::Vector3d> read_xyz(const std::string& path) {
  const std::string bytes = bytes_of(path);
  const std::string_view text = without_mark(bytes);
  std::vector<Eigen::Vector3d> points;
  std::size_t number = 0, without = 0;  // lines; the first one that has no point
  const auto refuse = [&path](std::size_t line, const char* why) {
    throw Refusal(refusal::kBrokenFile, path + ": line " + std::to_string(line) + why);
  };
  for (std::size_t start = 0; start < text.size();) {
    ++number;
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line = text.substr(start, end - start);
    start = end + 1;
    if (has_decimal_commas(line)) refuse(number, " has commas in its numbers: write 0.12, not 0,12");
    Eigen::Vector3d p;
    int axis = 0;
    bool is_empty = true;
    for (; axis < 3; ++axis) {
      const std::size_t word = line.find_first_not_of(" \t\r,;");
      if (word == std::string_view::npos) break;
      is_empty = false;
      line = line.substr(word);
      const auto [stop, error] = number_from(line.data(), line.data() + line.size(), p[axis]);
      if (error != std::errc()) break;
      line = line.substr(stop - line.data());
    }
    if (axis == 3)
      points.push_back(p);
    else if (!is_empty && (!points.empty() || (axis == 2 && number > 1)))
      refuse(number, " has no x y z");
    else if (!is_empty && without == 0)  // words, or a count: of a heading
      without = number;
    check_count(points.size(), 0, path);
  }
  if (points.empty() && without > 0 && number > 1) refuse(without, " has no x y z");
  return points;
}

}  // namespace tensegric_fit::mesh_files
