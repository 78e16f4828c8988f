#include "booth/scan_bag.hpp"

#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/view.h>

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

sensor_msgs::PointCloud2::ConstPtr first_scan(const rosbag::Bag& bag) {
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  sensor_msgs::PointCloud2::ConstPtr first;
  for (const rosbag::MessageInstance& message : view) {
    const bool preferred = is_scan_topic(message.getTopic());
    if (first && !preferred) continue;
    const sensor_msgs::PointCloud2::ConstPtr cloud = message.instantiate<sensor_msgs::PointCloud2>();
    if (preferred && cloud) return cloud;
    if (!first) first = cloud;
  }
  return first;
}

}  // namespace

pcl::PCLPointCloud2 read_bag_scan(const std::string& path) {
  sensor_msgs::PointCloud2::ConstPtr message;
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    message = first_scan(bag);
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
