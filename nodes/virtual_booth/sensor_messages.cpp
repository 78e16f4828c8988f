#include "virtual_booth/sensor_messages.hpp"

#include "ros/transform_message.hpp"
#include "scan_files/cloud_message.hpp"

namespace tensegric_fit::virtual_booth {

tf2_msgs::TFMessage sensor_poses(const std::vector<SensorScan>& scans, const std::string& frame_id,
                                 const std::string& sensor_frames, const ros::Time& stamp) {
  tf2_msgs::TFMessage poses;
  for (std::size_t sensor = 0; sensor < scans.size(); ++sensor) {
    geometry_msgs::TransformStamped& pose = poses.transforms.emplace_back();
    pose.header.frame_id = frame_id;
    pose.header.stamp = stamp;
    pose.child_frame_id = sensor_frames + std::to_string(sensor);
    pose.transform = node::transform_of(scans[sensor].pose.booth_from_sensor);
  }
  return poses;
}

sensor_msgs::PointCloud2 sensor_cloud(const SensorScan& scan, const std::string& sensor_frame,
                                      const ros::Time& stamp) {
  const Eigen::Isometry3d sensor_from_booth = scan.pose.booth_from_sensor.inverse();
  geometry::PointCloud cloud;
  for (const Eigen::Vector3d& p : scan.cloud.points) cloud.points.push_back(sensor_from_booth * p);
  return scan_files::cloud_message(cloud, sensor_frame, stamp);
}

}  // namespace tensegric_fit::virtual_booth
