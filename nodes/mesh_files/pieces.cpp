#include "mesh_files/pieces.hpp"

#include <algorithm>
#include <numeric>

namespace tensegric_fit::mesh_files {

Pieces::Pieces(const geometry::TriangleMesh& mesh)
    : parent_(mesh.triangles.size()), against_(mesh.triangles.size(), 0) {
  constexpr double kMostFaults = 0.01;  // share of edges: a surface with one side only
  std::iota(parent_.begin(), parent_.end(), 0);
  const std::vector<geometry::TriangleSide> sides = geometry::sorted_sides(mesh);
  std::size_t edges = 0;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    if (end - i != 2) continue;
    ++edges;
    if (!join(sides[i].triangle(), sides[i + 1].triangle(), sides[i].forward == sides[i + 1].forward))
      one_sided_.push_back(sides[i].triangle());
  }
  have_two_sides_ = static_cast<double>(one_sided_.size()) <= kMostFaults * static_cast<double>(edges);
}

bool Pieces::join(int a, int b, bool against) {
  const auto [of_a, a_against] = seen(a);
  const auto [of_b, b_against] = seen(b);
  const bool differ = against != (a_against != b_against);
  if (of_a == of_b) return !differ;
  parent_[std::max(of_a, of_b)] = std::min(of_a, of_b);
  against_[std::max(of_a, of_b)] = differ;
  return true;
}

std::pair<int, bool> Pieces::seen(int t) {
  bool against = false;
  int root = t;
  for (; parent_[root] != root; root = parent_[root]) against = against != (against_[root] != 0);
  for (bool left = against; parent_[t] != root && t != root;) {  // shorter for the next time
    const int next = parent_[t];
    const bool further = left != (against_[t] != 0);
    parent_[t] = root;
    against_[t] = left;
    left = further;
    t = next;
  }
  return {root, against};
}

geometry::TriangleMesh turned_alike(geometry::TriangleMesh mesh) {
  Pieces pieces(mesh);
  std::vector<char> stays(mesh.triangles.size(), 0);  // by piece
  for (const int triangle : pieces.one_sided()) stays[pieces.root(triangle)] = 1;
  // Of each piece: area that runs as its first triangle does, less the other.
  std::vector<double> with_first(mesh.triangles.size(), 0);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Eigen::Vector3i& t = mesh.triangles[f];
    const double area =
        geometry::area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).norm();
    const int triangle = static_cast<int>(f);
    with_first[pieces.root(triangle)] += pieces.is_against(triangle) ? -area : area;
  }
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const int triangle = static_cast<int>(f);
    if (stays[pieces.root(triangle)]) continue;
    if (pieces.is_against(triangle) == (with_first[pieces.root(triangle)] >= 0))
      std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
  }
  return mesh;
}

}  // namespace tensegric_fit::mesh_files
