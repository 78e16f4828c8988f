/// A message of points and nothing else.
#pragma once

#include <sensor_msgs/point_cloud2_iterator.h>

namespace tensegric_fit {

/// One row, 12 bytes per point, all of them at the origin.
inline sensor_msgs::PointCloud2 xyz_cloud(std::size_t points) {
  constexpr int kFloat = sensor_msgs::PointField::FLOAT32;
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(3, "x", 1, kFloat, "y", 1, kFloat, "z", 1, kFloat);
  modifier.resize(points);
  return cloud;
}

}  // namespace tensegric_fit
