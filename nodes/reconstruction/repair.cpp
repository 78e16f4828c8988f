#include "reconstruction/repair.hpp"

#include <algorithm>

#include "geometry/status.hpp"
#include "reconstruction/sides.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using geometry::TriangleMesh;

TriangleMesh largest_piece(const TriangleMesh& mesh) {
  const std::vector<int> component = geometry::components_of(mesh);
  std::vector<int> size(mesh.triangles.size());
  for (int c : component) ++size[c];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<char> keep(component.size());
  std::transform(component.begin(), component.end(), keep.begin(), [&](int c) { return c == largest; });
  return geometry::submesh(mesh, keep);
}

TriangleMesh without_degenerate(TriangleMesh mesh) {
  auto& triangles = mesh.triangles;
  const auto degenerate = [](const Eigen::Vector3i& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), degenerate), triangles.end());
  return mesh;
}

}  // namespace

TriangleMesh one_closed_surface(const TriangleMesh& surface) {
  TriangleMesh mesh = without_degenerate(surface);
  if (mesh.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kNotABody, "the points enclose nothing");
  mesh = largest_piece(mesh);
  constexpr int kMostRounds =
      4;  // splitting can leave several small pieces, and closing can touch old vertices
  for (int round = 0; round < kMostRounds; ++round) {
    mesh = split_fans(mesh, sides_across(mesh));
    close_loops(mesh);
    mesh = largest_piece(mesh);
    if (geometry::is_closed(mesh)) break;
  }
  if (!geometry::is_closed(mesh))
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the reconstructed surface cannot be closed");
  if (geometry::cone_volume(mesh.vertices, mesh.triangles, mesh.vertices.front()) < 0)
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace tensegric_fit::reconstruction
