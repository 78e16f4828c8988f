/// Scans from files: PLY, PCD, or the first PointCloud2 of a bag.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string>

namespace tensegric_fit::booth {

/// By the file's ending: .ply, .pcd, .bag. \throw Refusal broken_file, wrong_fields, bad_option (another ending)
pcl::PCLPointCloud2 read_scan(const std::string& path);

}  // namespace tensegric_fit::booth
