/// A plane as the ground.
#pragma once

#include <Eigen/Geometry>

namespace tensegric_fit::reconstruction {

/// Takes the plane (unit normal, up) with normal . x = offset to z = 0, and the point of it under `middle` to
/// the origin. The turn is the smallest one.
Eigen::Isometry3d level(const Eigen::Vector3d& normal, double offset, const Eigen::Vector3d& middle);

}  // namespace tensegric_fit::reconstruction
