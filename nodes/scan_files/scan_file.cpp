#include "scan_files/scan_file.hpp"

#include <pcl/PolygonMesh.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "scan_files/pcd_file.hpp"
#include "scan_files/scan_bag.hpp"

namespace tensegric_fit::scan_files {
namespace {

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

bool is_scan_name(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".ply" || ending == ".pcd" || ending == ".bag";
}

pcl::PCLPointCloud2 read_scan(const std::string& path) {
  const std::string ending = ending_of(path);
  pcl::PCLPointCloud2 scan;
  if (ending == ".ply") {
    pcl::PolygonMesh file;
    geometry::read_ply(path, file);
    scan = std::move(file.cloud);
  } else if (ending == ".pcd") {
    scan = read_pcd(path);
  } else if (ending == ".bag") {
    scan = read_bag_scan(path);
  } else {
    throw geometry::Refusal(geometry::refusal::kBadOption, path + ": a scan file ends in .ply, .pcd or .bag");
  }
  return scan;
}

}  // namespace tensegric_fit::scan_files
