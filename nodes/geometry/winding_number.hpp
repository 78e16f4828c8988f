/// Whether a place is inside a closed mesh.
#pragma once

#include <Eigen/Core>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// Solid angle of a closed mesh seen from a point over that of a sphere: 1 inside, 0 outside (van Oosterom,
/// Strackee 1983).
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace tensegric_fit::geometry
