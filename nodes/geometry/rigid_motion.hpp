/// Small rigid motions as a registration solves for them; the turn between two directions.
#pragma once

#include <Eigen/Geometry>

namespace tensegric_fit::geometry {

/// A turn, rad, then a shift, m; about some centre.
using SmallMotion = Eigen::Matrix<double, 6, 1>;

/// Turns about `centre` by the angle |turn|, rad, round the axis `turn`, then shifts.
inline Eigen::Isometry3d motion_about(const Eigen::Vector3d& centre, const Eigen::Vector3d& turn,
                                      const Eigen::Vector3d& shift) {
  const double angle = turn.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX();
  return Eigen::Translation3d(centre + shift) * Eigen::AngleAxisd(angle, axis) *
         Eigen::Translation3d(-centre);
}

inline Eigen::Isometry3d motion_about(const Eigen::Vector3d& centre, const SmallMotion& motion) {
  return motion_about(centre, motion.head<3>(), motion.tail<3>());
}

/// Turns `from` onto `to`, of any lengths but 0, by the smaller angle. In a source of its own: the SVD that
/// Eigen takes for opposite directions is 3 to 5 s of compiling wherever it is called.
Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// How far small motions about `centre` move a point along `normal`: the row of a registration from points to
/// planes.
inline SmallMotion along_normal(const Eigen::Vector3d& point, const Eigen::Vector3d& centre,
                                const Eigen::Vector3d& normal) {
  SmallMotion row;
  row << (point - centre).cross(normal), normal;
  return row;
}

}  // namespace tensegric_fit::geometry
