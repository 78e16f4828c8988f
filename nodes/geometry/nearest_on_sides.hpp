/// The point of a triangle's outline that is nearest to another.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>

namespace tensegric_fit::geometry {

/// Barycentric coordinates: none negative, sum 1. `beyond`: those of `query` seen along the normal; only
/// sides opposite to a corner of which it is negative can be nearest, and are looked at. \pre one of them is
inline Eigen::Vector3d nearest_on_sides(const std::array<Eigen::Vector3d, 3>& corners,
                                        const Eigen::Vector3d& beyond, const Eigen::Vector3d& query) {
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (beyond[k] >= 0) continue;
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const Eigen::Vector3d along = corners[b] - corners[a];
    const double length = along.squaredNorm();
    const double t = length > 0 ? std::clamp(along.dot(query - corners[a]) / length, 0.0, 1.0) : 0.0;
    const double distance = (query - corners[a] - t * along).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest.setZero();
    nearest[a] = 1 - t;
    nearest[b] = t;
  }
  return nearest;
}

}  // namespace tensegric_fit::geometry
