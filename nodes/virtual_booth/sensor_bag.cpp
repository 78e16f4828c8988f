#include "virtual_booth/sensor_bag.hpp"

#include <fmt/format.h>

#include <fstream>

#include "scan_files/bag_messages.hpp"
#include "virtual_booth/sensor_messages.hpp"

namespace tensegric_fit::virtual_booth {
namespace {

constexpr double kLinger = 2;  // s
const ros::Duration kApart(0.001);

template <typename Seen>
std::vector<SensorPose> poses_of(const std::vector<Seen>& seen) {
  std::vector<SensorPose> poses;
  for (const Seen& one : seen) poses.push_back(one.pose);
  return poses;
}

/// Before what the sensors send and after it: rosbag play ends with its last message, and what is still on
/// its way then is lost.
void write_poses(rosbag::Bag& bag, const std::vector<SensorPose>& sensors, const std::string& frame_id,
                 const std::string& frames, const ros::Time& stamp) {
  for (const double later : {0.0, kLinger})
    scan_files::write_latched(bag, "/tf_static", stamp + ros::Duration(later),
                              sensor_poses(sensors, frame_id, frames, stamp));
}

}  // namespace

void write_sensor_bag(const std::string& path, const std::vector<SensorScan>& scans,
                      const std::string& frame_id, std::chrono::nanoseconds stamp) {
  const std::string frames = "sensor_";
  const ros::Time start = scan_files::time_of(stamp);
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  write_poses(bag, poses_of(scans), frame_id, frames, start);
  for (std::size_t sensor = 0; sensor < scans.size(); ++sensor) {
    const std::string name = std::to_string(sensor);
    const ros::Time seen = start + kApart * static_cast<double>(sensor);
    scan_files::write_latched(bag, "/sensors/" + name + "/points", seen,
                              sensor_cloud(scans[sensor], frames + name, seen));
  }
}

void write_camera_bag(const std::string& path, const std::vector<DepthPicture>& pictures,
                      const std::string& frame_id, std::chrono::nanoseconds stamp) {
  const std::string frames = "camera_";
  const ros::Time start = scan_files::time_of(stamp);
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  write_poses(bag, poses_of(pictures), frame_id, frames, start);
  for (std::size_t camera = 0; camera < pictures.size(); ++camera) {
    const std::string name = std::to_string(camera), topics = "/cameras/" + name;
    const ros::Time seen = start + kApart * static_cast<double>(camera);
    scan_files::write_latched(bag, topics + "/camera_info", seen,
                              camera_info(pictures[camera], frames + name, seen));
    scan_files::write_latched(bag, topics + "/image", seen,
                              depth_image(pictures[camera], frames + name, seen));
  }
}

void write_camera_poses(const std::string& path, const std::vector<DepthPicture>& pictures) {
  std::ofstream file(path);
  file << "cameras:\n";
  for (std::size_t camera = 0; camera < pictures.size(); ++camera) {
    const Eigen::Isometry3d& pose = pictures[camera].pose.booth_from_sensor;
    const Eigen::Vector3d& at = pose.translation();
    file << fmt::format("  {}: {{position: [{:.6f}, {:.6f}, {:.6f}], rotation: [", camera, at.x(), at.y(),
                        at.z());
    for (int row = 0; row < 3; ++row)
      file << fmt::format("{}[{:.8f}, {:.8f}, {:.8f}]", row == 0 ? "" : ", ", pose(row, 0), pose(row, 1),
                          pose(row, 2));
    file << "]}\n";
  }
  file.flush();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace tensegric_fit::virtual_booth
