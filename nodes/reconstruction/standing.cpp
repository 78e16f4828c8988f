#include "reconstruction/standing.hpp"

#include "geometry/rigid_motion.hpp"

namespace tensegric_fit::reconstruction {

Eigen::Isometry3d level(const Eigen::Vector3d& normal, double offset, const Eigen::Vector3d& middle) {
  const Eigen::Vector3d origin = middle + (offset - normal.dot(middle)) * normal;
  Eigen::Isometry3d result(geometry::shortest_turn(normal, Eigen::Vector3d::UnitZ()));
  result.translation() = -(result.linear() * origin);
  return result;
}

}  // namespace tensegric_fit::reconstruction
