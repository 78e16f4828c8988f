/// What the sensors of a booth send (ROS).
#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <string>
#include <vector>

#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::virtual_booth {

/// Where sensors are believed to stand in `frame_id`; sensor k has the frame `sensor_frames` + k.
tf2_msgs::TFMessage sensor_poses(const std::vector<SensorPose>& sensors, const std::string& frame_id,
                                 const std::string& sensor_frames, const ros::Time& stamp);

/// x y z as float32 in the sensor's own frame.
sensor_msgs::PointCloud2 sensor_cloud(const SensorScan& scan, const std::string& sensor_frame,
                                      const ros::Time& stamp);

/// 16UC1, millimetres; 0 where nothing was seen.
sensor_msgs::Image depth_image(const DepthPicture& picture, const std::string& camera_frame,
                               const ros::Time& stamp);

/// The lens as plumb_bob; the rectified image has the same camera matrix.
sensor_msgs::CameraInfo camera_info(const DepthPicture& picture, const std::string& camera_frame,
                                    const ros::Time& stamp);

}  // namespace tensegric_fit::virtual_booth
