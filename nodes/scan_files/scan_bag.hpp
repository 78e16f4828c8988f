/// Scans in bags.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <chrono>
#include <string>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::scan_files {

/// The first sensor_msgs/PointCloud2 of a bag: on the topic scan/points (in any namespace) if there is one,
/// else on the only one with clouds. \throw Refusal broken_file: not there, truncated, not a bag, or without
/// a point cloud; bad_option: clouds on several topics, none of them scan/points
pcl::PCLPointCloud2 read_bag_scan(const std::string& path);

/// One message on /scan/points, x y z as float32. `stamp`: since 1970. Same arguments, same bytes. \throw
/// std::runtime_error
void write_bag_scan(const std::string& path, const geometry::PointCloud& cloud, const std::string& frame_id,
                    std::chrono::nanoseconds stamp);

}  // namespace tensegric_fit::scan_files
