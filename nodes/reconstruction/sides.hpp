/// Sides of triangles and what lies across them: what cuts a surface open and closes it needs them.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// Side k of a triangle runs from corner k to corner k + 1. Corners are numbered 3 * triangle + k, sides like
/// the corners that they start from.
inline int next_corner(int corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// For each side the one across it in the neighbouring triangle, or -1 where it does not have exactly one
/// that runs back.
std::vector<int> sides_across(const geometry::TriangleMesh& mesh);

/// Gives each fan of triangles around a vertex a vertex of its own; fans end at sides with -1 in `across`.
geometry::TriangleMesh split_fans(const geometry::TriangleMesh& mesh, const std::vector<int>& across);

/// Closes every boundary loop with a fan around the mean of its vertices. \pre no vertex has two fans
void close_loops(geometry::TriangleMesh& mesh);

}  // namespace tensegric_fit::reconstruction
