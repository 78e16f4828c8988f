/// What of a body mesh the scan saw.
#pragma once

#include "geometry/point_tree.hpp"
#include "reconstruction/reconstruct.hpp"

namespace tensegric_fit::reconstruction {

/// One flag per vertex: 1 where the nearest of the first `seen` points of the tree is farther away than
/// `distance`.
std::vector<char> filled_vertices(const geometry::TriangleMesh& mesh, const geometry::PointTree& points,
                                  std::size_t seen, double distance);

/// Connected groups of triangles whose three corners are filled, largest first.
std::vector<Hole> holes_of(const geometry::TriangleMesh& mesh, const std::vector<char>& filled);

}  // namespace tensegric_fit::reconstruction
