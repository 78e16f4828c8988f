/// A booth of twelve sensors that send what they recorded of virtual body "a" or "b".
#pragma once

#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <string>
#include <vector>

namespace tensegric_fit::tests {

inline constexpr int kSensors = 12;

/// A virtual body as all sensors saw it. Its sensors' frames are named after it: the booth stands otherwise
/// for each.
struct Recording {
  std::vector<sensor_msgs::PointCloud2> clouds;
  tf2_msgs::TFMessage poses;
};

const Recording& recorded(const std::string& body);

/// The sensors of the booth in that namespace.
class RecordedBooth {
 public:
  explicit RecordedBooth(const std::string& name_space);

  /// Whether so many listen to each sensor.
  bool heard(std::uint32_t listeners = 1) const;

  void send(const std::string& body, int sensor, double stamp);
  void send(const sensor_msgs::PointCloud2& cloud, int sensor);
  /// `but`: a sensor that is silent.
  void send_all(const std::string& body, double stamp, int but = -1);

 private:
  const std::string prefix_;  // of frames
  std::vector<ros::Publisher> sensors_;
  ros::Publisher tf_;
};

}  // namespace tensegric_fit::tests
