/// Point clouds as messages, and messages in bags.
#pragma once

#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::scan_files {

/// x y z as float32.
sensor_msgs::PointCloud2 cloud_message(const geometry::PointCloud& cloud, const std::string& frame_id,
                                       const ros::Time& stamp);

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
