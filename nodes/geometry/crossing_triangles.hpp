/// Where a surface passes through itself.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Points in which an edge of one triangle goes through the inside of the other; none where they are apart,
/// only touch, or lie in one plane.
std::vector<Eigen::Vector3d> passages(const Corners& one, const Corners& other);

/// How far the corners of the one reach behind the other's plane, whichever of the two is less: by how much
/// triangles that cross would have to be moved apart. \pre both have an area
double crossing_depth(const Corners& one, const Corners& other);

/// Pairs of triangles without a common corner that cross, of which at least one has a `looked_at` vertex: in
/// ascending order, the lower number first. \pre indices in range, one flag a vertex, all finite
std::vector<std::pair<int, int>> crossing_pairs(const std::vector<Eigen::Vector3d>& vertices,
                                                const std::vector<Eigen::Vector3i>& triangles,
                                                const std::vector<char>& looked_at);

}  // namespace tensegric_fit::geometry
