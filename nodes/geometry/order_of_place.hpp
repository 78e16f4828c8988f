/// Triangles in an order that is the surface's own.
#pragma once

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// Triangles that are near each other one after the other (Morton's order of their middles), each from the
/// corner on that comes first, running as it did: the same in whatever order a file has triangles and
/// vertices, whichever way its axes point and whatever its unit, but for rounding. \pre finite vertices of
/// triangles
std::vector<Eigen::Vector3i> in_order_of_place(const TriangleMesh& mesh);

}  // namespace tensegric_fit::geometry
