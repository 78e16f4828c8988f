#include "virtual_booth/sensor_messages.hpp"

#include <algorithm>
#include <cmath>

#include "ros/transform_message.hpp"
#include "scan_files/cloud_message.hpp"

namespace tensegric_fit::virtual_booth {

tf2_msgs::TFMessage sensor_poses(const std::vector<SensorPose>& sensors, const std::string& frame_id,
                                 const std::string& sensor_frames, const ros::Time& stamp) {
  tf2_msgs::TFMessage poses;
  for (std::size_t sensor = 0; sensor < sensors.size(); ++sensor) {
    geometry_msgs::TransformStamped& pose = poses.transforms.emplace_back();
    pose.header.frame_id = frame_id;
    pose.header.stamp = stamp;
    pose.child_frame_id = sensor_frames + std::to_string(sensor);
    pose.transform = node::transform_of(sensors[sensor].booth_from_sensor);
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

sensor_msgs::Image depth_image(const DepthPicture& picture, const std::string& camera_frame,
                               const ros::Time& stamp) {
  sensor_msgs::Image image;
  image.header.frame_id = camera_frame;
  image.header.stamp = stamp;
  image.width = picture.columns;
  image.height = picture.rows;
  image.encoding = "16UC1";
  image.step = 2 * image.width;
  image.data.reserve(2 * picture.depth.size());
  for (float depth : picture.depth) {
    const auto millimetres =
        static_cast<std::uint16_t>(std::isnan(depth) ? 0 : std::clamp(std::lround(1000 * depth), 0l, 65535l));
    image.data.push_back(millimetres & 0xff);
    image.data.push_back(millimetres >> 8);
  }
  return image;
}

sensor_msgs::CameraInfo camera_info(const DepthPicture& picture, const std::string& camera_frame,
                                    const ros::Time& stamp) {
  sensor_msgs::CameraInfo info;
  info.header.frame_id = camera_frame;
  info.header.stamp = stamp;
  info.width = picture.columns;
  info.height = picture.rows;
  info.distortion_model = "plumb_bob";
  const Lens& lens = picture.lens;
  info.D = {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
  info.K = {picture.fx, 0, picture.cx, 0, picture.fy, picture.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {picture.fx, 0, picture.cx, 0, 0, picture.fy, picture.cy, 0, 0, 0, 1, 0};
  return info;
}

}  // namespace tensegric_fit::virtual_booth
