/// Point clouds as messages.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::scan_files {

/// x y z as float32.
sensor_msgs::PointCloud2 cloud_message(const geometry::PointCloud& cloud, const std::string& frame_id,
                                       const ros::Time& stamp);

}  // namespace tensegric_fit::scan_files
