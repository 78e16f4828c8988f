/// Messages in bags.
#pragma once

#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>

#include <chrono>
#include <limits>
#include <string>
#include <vector>

namespace tensegric_fit::scan_files {

/// Since 1970.
inline ros::Time time_of(std::chrono::nanoseconds stamp) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp.count()));
}

/// The scans of a bag, the first `most`, on the topic that read_bag_scan (scan_bag.hpp) takes, in their
/// order. \throw Refusal as read_bag_scan
std::vector<sensor_msgs::PointCloud2::ConstPtr> read_bag_scans(
    const std::string& path, std::size_t most = std::numeric_limits<std::size_t>::max());

/// As recorded from a latched topic, so that `rosbag play` latches it.
template <typename Message>
void write_latched(rosbag::Bag& bag, const std::string& topic, const ros::Time& stamp,
                   const Message& message) {
  const auto connection = boost::make_shared<ros::M_string>(
      ros::M_string{{"topic", topic},
                    {"type", ros::message_traits::datatype(message)},
                    {"md5sum", ros::message_traits::md5sum(message)},
                    {"message_definition", ros::message_traits::definition(message)},
                    {"latching", "1"}});
  bag.write(topic, stamp, message, connection);
}

}  // namespace tensegric_fit::scan_files
