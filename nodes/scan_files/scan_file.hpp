/// Scans from files: PLY, PCD, or the first PointCloud2 of a bag.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string>

namespace tensegric_fit::scan_files {

/// Whether a file of that name can be a scan, by its ending: .ply, .pcd, .bag, in either case.
bool is_scan_name(const std::string& path);

/// By the file's ending. The fields are as the file has them;
/// geometry::points_of checks them. \throw Refusal broken_file, bad_option (another ending)
pcl::PCLPointCloud2 read_scan(const std::string& path);

}  // namespace tensegric_fit::scan_files
