/// What the sensors of a booth send (ROS).
#pragma once

#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::virtual_booth {

/// Where the sensors are believed to stand in `frame_id`; sensor k has the frame `sensor_frames` + k.
tf2_msgs::TFMessage sensor_poses(const std::vector<SensorScan>& scans, const std::string& frame_id,
                                 const std::string& sensor_frames, const ros::Time& stamp);

/// x y z as float32 in the sensor's own frame.
sensor_msgs::PointCloud2 sensor_cloud(const SensorScan& scan, const std::string& sensor_frame,
                                      const ros::Time& stamp);

}  // namespace tensegric_fit::virtual_booth
