/// What of a body mesh the scan saw.
#pragma once

#include "reconstruction/reconstruct.hpp"

namespace tensegric_fit::reconstruction {

/// One flag a vertex: 1 where the nearest of `points` is farther away than `distance`.
std::vector<char> filled_vertices(const geometry::TriangleMesh& mesh,
                                  const std::vector<Eigen::Vector3d>& points, double distance);

/// Connected groups of triangles whose three corners are filled, largest first.
std::vector<Hole> holes_of(const geometry::TriangleMesh& mesh, const std::vector<char>& filled);

}  // namespace tensegric_fit::reconstruction
