/// What the sensors of a booth send, as a bag.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::virtual_booth {

/// Sensor k on /sensors/k/points, x y z as float32 in its own frame sensor_k, a millisecond after the one
/// before it; on /tf_static where the sensors are believed to stand in `frame_id`. Recorded as from latched
/// topics; the places once more 2 s later, so that a plain `rosbag play` loses no cloud. Same arguments, same
/// bytes. \throw std::runtime_error
void write_sensor_bag(const std::string& path, const std::vector<SensorScan>& scans,
                      const std::string& frame_id, std::chrono::nanoseconds stamp);

/// Camera k as cameras/k/image and cameras/k/camera_info, a millisecond after the one before it, and on
/// /tf_static where cameras are believed to stand; otherwise as write_sensor_bag.
void write_camera_bag(const std::string& path, const std::vector<DepthPicture>& pictures,
                      const std::string& frame_id, std::chrono::nanoseconds stamp);

/// Where the cameras are believed to stand, as depth_cameras::load_camera_poses reads it. \throw
/// std::runtime_error
void write_camera_poses(const std::string& path, const std::vector<DepthPicture>& pictures);

}  // namespace tensegric_fit::virtual_booth
