/// Point clouds as messages.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::scan_files {

/// x y z as float32.
sensor_msgs::PointCloud2 cloud_message(const geometry::PointCloud& cloud, const std::string& frame_id,
                                       const ros::Time& stamp);

/// With all its fields.
pcl::PCLPointCloud2 cloud_in(const sensor_msgs::PointCloud2& message);

}  // namespace tensegric_fit::scan_files
