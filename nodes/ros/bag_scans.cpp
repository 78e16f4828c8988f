#include "ros/bag_scans.hpp"

#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "files/bag_structure.hpp"
#include "files/checked_message.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/status.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

constexpr std::size_t kFewPoints = 5000;  // the reconstruction's min_points
constexpr double kManyNotFinite = 0.3;    // share; a depth image has gaps, but a body fills most of it
const std::string kScanTopic = "scan/points";

}  // namespace

void ScanChecker::find(bool hinders, const std::string& name, const std::string& what,
                       const std::string& advice) {
  check_.findings.push_back({hinders, name, what, advice});
}

void ScanChecker::look_at(const rosbag::MessageInstance& message) {
  if (const auto transforms = files::checked_message<tf2_msgs::TFMessage>(message))
    for (const geometry_msgs::TransformStamped& transform : transforms->transforms)
      parent_of_[transform.child_frame_id] = transform.header.frame_id;
  const std::string& topic = message.getTopic();
  const auto scan = files::checked_message<sensor_msgs::PointCloud2>(message);
  if (scan)
    look_at(topic, *scan);
  else if (files::is_scan_topic(topic) && said_.insert(topic + " type").second)
    find(true, "wrong_type", fmt::format("{}: is {}", topic, message.getDataType()),
         "the chain takes sensor_msgs/PointCloud2 there");
}

void ScanChecker::look_at(const std::string& topic, const sensor_msgs::PointCloud2& scan) {
  BagScan found;
  found.topic = topic;
  found.scan_id = tag_of(scan).scan_id;
  check_stamp(topic, scan.header);
  check_points(topic, scan, found);
  frames_of_[topic].insert(scan.header.frame_id);
  check_.scans.push_back(found);
}

void ScanChecker::check_stamp(const std::string& topic, const std_msgs::Header& header) {
  if (header.stamp.isZero() && said_.insert(topic + " stamp").second)
    find(false, "no_stamp", topic + ": scans carry no stamp",
         "let the driver stamp them: stamps say what belongs to one capture");
  if (header.frame_id.empty() && said_.insert(topic + " frame").second)
    find(false, "no_frame", topic + ": scans carry no frame", "set the driver's frame_id");
  const auto before = last_.find(topic);
  if (before != last_.end() && header.stamp < before->second.stamp)
    find(files::is_scan_topic(topic), "stamps_backwards",
         fmt::format("{}: a scan stamped {:.3f} comes after one stamped {:.3f}", topic, header.stamp.toSec(),
                     before->second.stamp.toSec()),
         "record from one clock; two recordings in one bag are split with rosbag filter");
  last_[topic] = header;
}

void ScanChecker::check_points(const std::string& topic, const sensor_msgs::PointCloud2& scan,
                               BagScan& found) {
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(scan, cloud);
  try {
    const std::vector<Eigen::Vector3d> points = geometry::points_of(cloud).points;
    const auto bad =
        std::count_if(points.begin(), points.end(), [](const Eigen::Vector3d& p) { return !p.allFinite(); });
    found.points = points.size();
    found.not_finite = points.empty() ? 0 : static_cast<double>(bad) / static_cast<double>(points.size());
    const std::size_t finite = points.size() - static_cast<std::size_t>(bad);
    if (finite < kFewPoints && files::is_scan_topic(topic))  // a sensor of many may see little
      find(true, "bad_scan",
           fmt::format("{}: scan {} has {} finite points of {}", topic, found.scan_id, finite, points.size()),
           fmt::format("a body takes {} and more", kFewPoints));
    else if (found.not_finite > kManyNotFinite)
      find(false, "not_finite",
           fmt::format("{}: scan {}: {:.0f} % of the points are not finite", topic, found.scan_id,
                       100 * found.not_finite),
           "look whether the sensors saw the customer");
  } catch (const geometry::Refusal& refusal) {
    find(files::is_scan_topic(topic), "bad_scan",
         fmt::format("{}: scan {}: {}: {}", topic, found.scan_id, refusal.code(), refusal.what()),
         "look at the driver's point fields and steps");
  }
}

std::set<std::string> ScanChecker::frames_of(const std::string& topic) const {
  const auto frames = frames_of_.find(topic);
  return frames == frames_of_.end() ? std::set<std::string>() : frames->second;
}

void ScanChecker::finish() {
  const bool has_scans = std::any_of(frames_of_.begin(), frames_of_.end(),
                                     [](const auto& entry) { return files::is_scan_topic(entry.first); });
  if (frames_of_.empty())
    find(true, "no_scan", "no sensor_msgs/PointCloud2 is in the bag", "record the booth's scans");
  else if (!has_scans && frames_of_.size() > 1)
    find(false, "sensors",
         fmt::format("no {}, but clouds on {} topics, as of the sensors of a booth: {} ...", kScanTopic,
                     frames_of_.size(), frames_of_.begin()->first),
         "the assembler joins them: roslaunch tensegric_fit booth.launch assemble:=true file:=BAG "
         "sensors:=YOUR.yaml, "
         "with their topics in YOUR.yaml as in launch/config/booth.yaml; a plain rosbag play needs "
         "--keep-alive, or "
         "may lose its last messages");
  else if (!has_scans)
    find(true, "wrong_topic",
         fmt::format("no topic is called {}; clouds are on {}", kScanTopic, frames_of_.begin()->first),
         fmt::format("rename it: rosbag play with {}:=/{}, or record it under that name",
                     frames_of_.begin()->first, kScanTopic));
  std::set<std::string> all;
  for (const auto& [topic, frames] : frames_of_) {
    all.insert(frames.begin(), frames.end());
    if (frames.size() > 1)
      find(false, "many_frames", fmt::format("{}: scans in {} frames", topic, frames.size()),
           "a booth has one frame: look at the driver's frame_id");
  }
  if (all.size() < 2) return;
  for (const std::string& frame : all)
    if (parent_of_.count(frame) == 0 && std::none_of(parent_of_.begin(), parent_of_.end(),
                                                     [&](const auto& tf) { return tf.second == frame; }))
      find(false, "no_tf", fmt::format("frame '{}' is in no transform of the bag", frame),
           "record /tf_static, too; after a split it is in the first part only");
}

}  // namespace tensegric_fit::node
