/// Rigid motions as tf messages.
#pragma once

#include <geometry_msgs/Transform.h>

#include <Eigen/Geometry>

namespace tensegric_fit::node {

inline geometry_msgs::Transform transform_of(const Eigen::Isometry3d& motion) {
  const Eigen::Quaterniond turn(motion.linear());
  geometry_msgs::Transform transform;
  transform.translation.x = motion.translation().x();
  transform.translation.y = motion.translation().y();
  transform.translation.z = motion.translation().z();
  transform.rotation.x = turn.x();
  transform.rotation.y = turn.y();
  transform.rotation.z = turn.z();
  transform.rotation.w = turn.w();
  return transform;
}

}  // namespace tensegric_fit::node
