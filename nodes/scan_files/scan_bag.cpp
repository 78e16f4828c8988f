#include "scan_files/scan_bag.hpp"

#include "scan_files/bag_messages.hpp"
#include "scan_files/cloud_message.hpp"

namespace tensegric_fit::scan_files {

pcl::PCLPointCloud2 read_bag_scan(const std::string& path) {
  return cloud_in(*read_bag_scans(path, 1).front());
}

void write_bag_scan(const std::string& path, const geometry::PointCloud& cloud, const std::string& frame_id,
                    std::chrono::nanoseconds stamp) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const ros::Time time = time_of(stamp);
  write_latched(bag, "/scan/points", time, cloud_message(cloud, frame_id, time));
}

}  // namespace tensegric_fit::scan_files
