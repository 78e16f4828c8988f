/// Small rigid motions as a registration solves for them.
#pragma once

#include <Eigen/Geometry>

namespace tensegric_fit::geometry {

/// Turns about `centre` by the angle |turn|, rad, round the axis `turn`, then shifts.
inline Eigen::Isometry3d motion_about(const Eigen::Vector3d& centre, const Eigen::Vector3d& turn,
                                      const Eigen::Vector3d& shift) {
  const double angle = turn.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX();
  return Eigen::Translation3d(centre + shift) * Eigen::AngleAxisd(angle, axis) *
         Eigen::Translation3d(-centre);
}

}  // namespace tensegric_fit::geometry
