#include "scan_files/bag_messages.hpp"

#include <fmt/format.h>
#include <rosbag/view.h>

#include <set>

#include "files/bag_structure.hpp"
#include "files/checked_message.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::scan_files {
namespace {

/// The topic of the scans. \throw Refusal broken_file: no clouds; bad_option: which of several topics is it?
std::string scan_topic(const rosbag::Bag& bag) {
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/PointCloud2"));
  std::set<std::string> topics, of_scans;
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    (files::is_scan_topic(connection->topic) ? of_scans : topics).insert(connection->topic);
  if (of_scans.size() > 1)
    throw geometry::Refusal(
        geometry::refusal::kBadOption,
        fmt::format("has scans of several booths, on {}: check_bag says how to take one out",
                    fmt::join(of_scans, ", ")));
  if (!of_scans.empty()) return *of_scans.begin();
  if (topics.empty())
    throw geometry::Refusal(geometry::refusal::kBrokenFile, "holds no sensor_msgs/PointCloud2 message");
  if (topics.size() > 1)
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "clouds on " + std::to_string(topics.size()) + " topics (" + *topics.begin() +
                                ", ...), none of them scan/points: the assembler joins sensors");
  return *topics.begin();
}

}  // namespace

std::vector<sensor_msgs::PointCloud2::ConstPtr> read_bag_scans(const std::string& path, std::size_t most) {
  files::check_bag_structure(path);
  std::vector<sensor_msgs::PointCloud2::ConstPtr> scans;
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    rosbag::View view(bag, rosbag::TopicQuery(scan_topic(bag)));
    for (const rosbag::MessageInstance& message : view) {
      if (scans.size() == most) break;
      if (const auto cloud = files::checked_message<sensor_msgs::PointCloud2>(message))
        scans.push_back(cloud);
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

}  // namespace tensegric_fit::scan_files
