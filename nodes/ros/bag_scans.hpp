/// The scans of a bag, each looked at.
#pragma once

#include <rosbag/message_instance.h>
#include <sensor_msgs/PointCloud2.h>

#include <map>
#include <set>
#include <string>

#include "ros/bag_check.hpp"

namespace tensegric_fit::node {

/// Sees all messages of a bag in their order and adds scans and findings to the check, which must outlive it.
class ScanChecker {
 public:
  explicit ScanChecker(BagCheck& check) : check_(check) {}

  void look_at(const rosbag::MessageInstance& message);
  /// What only the whole bag shows.
  void finish();
  std::set<std::string> frames_of(const std::string& topic) const;

 private:
  void find(bool hinders, const std::string& name, const std::string& what, const std::string& advice);
  void look_at(const std::string& topic, const sensor_msgs::PointCloud2& scan);
  void check_stamp(const std::string& topic, const std_msgs::Header& header);
  void check_points(const std::string& topic, const sensor_msgs::PointCloud2& scan, BagScan& found);

  BagCheck& check_;
  std::map<std::string, std_msgs::Header> last_;            // newest header by topic
  std::map<std::string, std::set<std::string>> frames_of_;  // by topic of clouds
  std::map<std::string, std::string> parent_of_;            // tf
  std::set<std::string> said_;                              // once a topic
};

}  // namespace tensegric_fit::node
