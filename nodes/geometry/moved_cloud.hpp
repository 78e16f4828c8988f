/// Clouds moved and put together.
#pragma once

#include <Eigen/Geometry>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::geometry {

/// Points and normals.
inline void move(PointCloud& cloud, const Eigen::Isometry3d& by) {
  for (Eigen::Vector3d& p : cloud.points) p = by * p;
  for (Eigen::Vector3d& n : cloud.normals) n = by.linear() * n;
}

/// Points and normals of another cloud behind those that it has.
inline void append(PointCloud& cloud, const PointCloud& more) {
  cloud.points.insert(cloud.points.end(), more.points.begin(), more.points.end());
  cloud.normals.insert(cloud.normals.end(), more.normals.begin(), more.normals.end());
}

}  // namespace tensegric_fit::geometry
