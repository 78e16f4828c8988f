/// Many points at once. Metres.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tensegric_fit::geometry {

/// \pre not empty
inline Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

inline std::vector<Eigen::Vector3d> moved(std::vector<Eigen::Vector3d> points, const Eigen::Isometry3d& by) {
  for (Eigen::Vector3d& p : points) p = by * p;
  return points;
}

}  // namespace tensegric_fit::geometry
