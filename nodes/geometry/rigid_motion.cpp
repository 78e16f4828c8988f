#include "geometry/rigid_motion.hpp"

namespace tensegric_fit::geometry {

Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace tensegric_fit::geometry
