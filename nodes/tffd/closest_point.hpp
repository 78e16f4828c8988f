/// The point of a triangle that is closest to a given point.
#pragma once

#include <Eigen/Core>
#include <array>

namespace tensegric_fit::tffd {

/// Barycentric coordinates of that point (none negative, sum 1). \pre the triangle has an area
Eigen::Vector3d closest_barycentric(const Eigen::Vector3d& q, const std::array<Eigen::Vector3d, 3>& corners);

}  // namespace tensegric_fit::tffd
