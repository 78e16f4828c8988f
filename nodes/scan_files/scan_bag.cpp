#include "scan_files/scan_bag.hpp"

#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/view.h>

#include <limits>
#include <set>

#include "files/bag_structure.hpp"
#include "geometry/status.hpp"
#include "scan_files/cloud_message.hpp"

namespace tensegric_fit::scan_files {
namespace {

constexpr char kTopic[] = "/scan/points";

bool is_scan_topic(const std::string& topic) {
  const std::string absolute = "/" + topic, wanted = kTopic;
  return absolute.size() >= wanted.size() &&
         absolute.compare(absolute.size() - wanted.size(), wanted.size(), wanted) == 0;
}

/// The topic of the scans. \throw Refusal broken_file: no clouds; bad_option: which of several topics is it?
std::string scan_topic(const rosbag::Bag& bag) {
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  std::set<std::string> topics;
  for (const rosbag::MessageInstance& message : view) {
    if (is_scan_topic(message.getTopic())) return message.getTopic();
    topics.insert(message.getTopic());
  }
  if (topics.empty())
    throw geometry::Refusal(geometry::refusal::kBrokenFile, "holds no sensor_msgs/PointCloud2 message");
  if (topics.size() > 1)
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "clouds on " + std::to_string(topics.size()) + " topics (" + *topics.begin() +
                                ", ...), none of them scan/points: the assembler joins sensors");
  return *topics.begin();
}

/// The first so many scans. \throw Refusal
std::vector<sensor_msgs::PointCloud2::ConstPtr> first_scans(const std::string& path, std::size_t most) {
  files::check_bag_structure(path);
  std::vector<sensor_msgs::PointCloud2::ConstPtr> scans;
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery(scan_topic(bag)));
    for (const rosbag::MessageInstance& message : view) {
      if (scans.size() == most) break;
      if (const auto cloud = message.instantiate<sensor_msgs::PointCloud2>()) scans.push_back(cloud);
    }
    if (scans.empty()) throw geometry::Refusal(geometry::refusal::kBrokenFile, "its scans cannot be read");
  } catch (const geometry::Refusal& refusal) {
    throw geometry::Refusal(refusal.code(), path + ": " + refusal.what());
  } catch (const std::exception& error) {  // rosbag and its streams throw many kinds
    throw geometry::Refusal(geometry::refusal::kBrokenFile,
                            path + ": is truncated or is not a bag: " + error.what());
  }
  return scans;
}

}  // namespace

pcl::PCLPointCloud2 read_bag_scan(const std::string& path) {
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(*first_scans(path, 1).front(), cloud);
  return cloud;
}

std::vector<sensor_msgs::PointCloud2::ConstPtr> read_bag_scans(const std::string& path) {
  return first_scans(path, std::numeric_limits<std::size_t>::max());
}

void write_bag_scan(const std::string& path, const geometry::PointCloud& cloud, const std::string& frame_id,
                    const ros::Time& stamp) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  write_latched(bag, kTopic, stamp, cloud_message(cloud, frame_id, stamp));
}

}  // namespace tensegric_fit::scan_files
