#include "booth/scan_bag.hpp"

#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/view.h>

#include <set>

#include "booth/cloud_message.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::booth {
namespace {

constexpr char kTopic[] = "/scan/points";

bool is_scan_topic(const std::string& topic) {
  const std::string absolute = "/" + topic, wanted = kTopic;
  return absolute.size() >= wanted.size() &&
         absolute.compare(absolute.size() - wanted.size(), wanted.size(), wanted) == 0;
}

/// Null where there is no cloud. \throw Refusal bad_option: which of several topics is the scan?
sensor_msgs::PointCloud2::ConstPtr first_scan(const rosbag::Bag& bag) {
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  sensor_msgs::PointCloud2::ConstPtr first;
  std::set<std::string> topics;
  for (const rosbag::MessageInstance& message : view) {
    const bool preferred = is_scan_topic(message.getTopic());
    topics.insert(message.getTopic());
    if (first && !preferred) continue;
    const sensor_msgs::PointCloud2::ConstPtr cloud = message.instantiate<sensor_msgs::PointCloud2>();
    if (preferred && cloud) return cloud;
    if (!first) first = cloud;
  }
  if (topics.size() > 1)
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "clouds on " + std::to_string(topics.size()) + " topics (" + *topics.begin() +
                                ", ...), none of them scan/points: the assembler joins sensors");
  return first;
}

}  // namespace

pcl::PCLPointCloud2 read_bag_scan(const std::string& path) {
  sensor_msgs::PointCloud2::ConstPtr message;
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    message = first_scan(bag);
  } catch (const geometry::Refusal& refusal) {
    throw geometry::Refusal(refusal.code(), path + ": " + refusal.what());
  } catch (const std::exception& error) {  // rosbag and its streams throw many kinds
    throw geometry::Refusal(geometry::refusal::kBrokenFile,
                            path + ": is truncated or is not a bag: " + error.what());
  }
  if (!message)
    throw geometry::Refusal(geometry::refusal::kBrokenFile,
                            path + ": holds no sensor_msgs/PointCloud2 message");
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(*message, cloud);
  return cloud;
}

void write_bag_scan(const std::string& path, const geometry::PointCloud& cloud, const std::string& frame_id,
                    const ros::Time& stamp) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  write_latched(bag, kTopic, stamp, cloud_message(cloud, frame_id, stamp));
}

}  // namespace tensegric_fit::booth
