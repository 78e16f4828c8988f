#include "booth/sensor_bag.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2_msgs/TFMessage.h>

#include "booth/cloud_message.hpp"
#include "ros/transform_message.hpp"

namespace tensegric_fit::booth {
namespace {

std::string name_of(std::size_t sensor) {
  return "sensor_" + std::to_string(sensor);
}

}  // namespace

void write_sensor_bag(const std::string& path, const std::vector<SensorScan>& scans,
                      const std::string& frame_id, const ros::Time& stamp) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  tf2_msgs::TFMessage poses;
  for (std::size_t sensor = 0; sensor < scans.size(); ++sensor) {
    geometry_msgs::TransformStamped& pose = poses.transforms.emplace_back();
    pose.header.frame_id = frame_id;
    pose.header.stamp = stamp;
    pose.child_frame_id = name_of(sensor);
    pose.transform = node::transform_of(scans[sensor].pose.booth_from_sensor);
  }
  write_latched(bag, "/tf_static", stamp, poses);
  const ros::Duration apart(0.001);
  for (std::size_t sensor = 0; sensor < scans.size(); ++sensor) {
    const Eigen::Isometry3d sensor_from_booth = scans[sensor].pose.booth_from_sensor.inverse();
    geometry::PointCloud cloud;
    for (const Eigen::Vector3d& p : scans[sensor].cloud.points) cloud.points.push_back(sensor_from_booth * p);
    const ros::Time seen = stamp + apart * static_cast<double>(sensor);
    write_latched(bag, "/sensors/" + std::to_string(sensor) + "/points", seen,
                  cloud_message(cloud, name_of(sensor), seen));
  }
}

}  // namespace tensegric_fit::booth
