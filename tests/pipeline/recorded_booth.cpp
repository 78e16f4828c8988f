#include "recorded_booth.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <map>

namespace tensegric_fit::tests {
namespace {

Recording recording_of(const std::string& body) {
  rosbag::Bag bag(std::string(TENSEGRIC_FIT_SCANS) + "/" + body + "/sensors.bag");
  Recording recording;
  recording.clouds.resize(kSensors);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (const auto poses = message.instantiate<tf2_msgs::TFMessage>()) recording.poses = *poses;
    if (const auto cloud = message.instantiate<sensor_msgs::PointCloud2>())
      recording.clouds.at(std::stoul(message.getTopic().substr(std::string("/sensors/").size()))) = *cloud;
  }
  for (auto& pose : recording.poses.transforms) pose.child_frame_id += body;
  for (auto& cloud : recording.clouds) cloud.header.frame_id += body;
  return recording;
}

}  // namespace

const Recording& recorded(const std::string& body) {
  static const std::map<std::string, Recording> recordings = {{"a", recording_of("a")},
                                                              {"b", recording_of("b")}};
  return recordings.at(body);
}

RecordedBooth::RecordedBooth(const std::string& name_space) : prefix_(name_space + "/") {
  ros::NodeHandle node(name_space);
  for (int sensor = 0; sensor < kSensors; ++sensor)
    sensors_.push_back(
        node.advertise<sensor_msgs::PointCloud2>("sensors/" + std::to_string(sensor) + "/points", 8));
  tf_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  tf2_msgs::TFMessage poses;
  for (const char* body : {"a", "b"})
    for (geometry_msgs::TransformStamped pose : recorded(body).poses.transforms) {
      pose.header.frame_id = prefix_ + pose.header.frame_id;
      pose.child_frame_id = prefix_ + pose.child_frame_id;
      poses.transforms.push_back(pose);
    }
  tf_.publish(poses);
}

bool RecordedBooth::heard(std::uint32_t listeners) const {
  return tf_.getNumSubscribers() != 0 &&
         std::all_of(sensors_.begin(), sensors_.end(), [listeners](const ros::Publisher& sensor) {
           return sensor.getNumSubscribers() >= listeners;
         });
}

void RecordedBooth::send(const std::string& body, int sensor, double stamp) {
  sensor_msgs::PointCloud2 cloud = recorded(body).clouds[sensor];
  cloud.header.stamp = ros::Time(stamp);
  cloud.header.frame_id = prefix_ + cloud.header.frame_id;
  send(cloud, sensor);
}

void RecordedBooth::send(const sensor_msgs::PointCloud2& cloud, int sensor) {
  sensors_[sensor].publish(cloud);
}

void RecordedBooth::send_all(const std::string& body, double stamp, int but) {
  for (int sensor = 0; sensor < kSensors; ++sensor)
    if (sensor != but) send(body, sensor, stamp + 0.005 * sensor);
}

}  // namespace tensegric_fit::tests
