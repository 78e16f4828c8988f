#include "reconstruction/sides.hpp"

#include "geometry/disjoint_sets.hpp"

namespace tensegric_fit::reconstruction {

using geometry::TriangleMesh;

std::vector<int> sides_across(const TriangleMesh& mesh) {
  const std::vector<geometry::TriangleSide> sides = geometry::sorted_sides(mesh);
  std::vector<int> across(sides.size(), -1);
  for (std::size_t i = 0, end; i < sides.size(); i = end) {
    for (end = i + 1;
         end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high;)
      ++end;
    if (end - i != 2 || sides[i].forward == sides[i + 1].forward) continue;
    across[sides[i].number] = sides[i + 1].number;
    across[sides[i + 1].number] = sides[i].number;
  }
  return across;
}

TriangleMesh split_fans(const TriangleMesh& mesh, const std::vector<int>& across) {
  geometry::DisjointSets fans(across.size());  // corners joined by the sides between their triangles
  for (int side = 0; side < static_cast<int>(across.size()); ++side) {
    if (across[side] < side) continue;
    fans.join(side, next_corner(across[side]));
    fans.join(next_corner(side), across[side]);
  }
  TriangleMesh result;
  result.triangles = mesh.triangles;
  std::vector<int> vertex(across.size(), -1);
  for (int corner = 0; corner < static_cast<int>(across.size()); ++corner) {
    const int r = fans.root(corner);
    if (vertex[r] < 0) {
      vertex[r] = static_cast<int>(result.vertices.size());
      result.vertices.push_back(mesh.vertices[mesh.triangles[corner / 3][corner % 3]]);
    }
    result.triangles[corner / 3][corner % 3] = vertex[r];
  }
  return result;
}

void close_loops(TriangleMesh& mesh) {
  const std::vector<int> across = sides_across(mesh);
  std::vector<int> next(mesh.vertices.size(), -1);  // along the boundary, against the sides' direction
  for (int side = 0; side < static_cast<int>(across.size()); ++side)
    if (across[side] < 0) {
      const int end = next_corner(side);
      next[mesh.triangles[end / 3][end % 3]] = mesh.triangles[side / 3][side % 3];
    }
  const int count = static_cast<int>(mesh.vertices.size());
  for (int start = 0; start < count; ++start) {
    if (next[start] < 0) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int length = 0;
    const int centre = static_cast<int>(mesh.vertices.size());
    for (int v = start; next[v] >= 0; ++length) {
      const int after = next[v];
      sum += mesh.vertices[v];
      mesh.triangles.emplace_back(v, after, centre);
      next[v] = -1;
      v = after;
    }
    mesh.vertices.push_back(sum / length);
  }
}

}  // namespace tensegric_fit::reconstruction
