/// PCD files, checked before PCL reads them: it allocates whatever a header promises.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string>

namespace tensegric_fit::scan_files {

/// ASCII, binary or compressed. \throw Refusal broken_file: not there, not PCD, or shorter than its header
/// says
pcl::PCLPointCloud2 read_pcd(const std::string& path);

}  // namespace tensegric_fit::scan_files
