// A PointCloud2 of any layout: fields, offsets, types, byte order, organisation, sizes that do not match.
#include <array>

#include "fuzz_target.hpp"
#include "geometry/point_cloud.hpp"
#include "input.hpp"
#include "scan_files/scan_file.hpp"

namespace {

constexpr std::array<const char*, 12> kNames{"x",  "y",  "z",  "normal_x", "normal_y", "normal_z",
                                             "nx", "ny", "nz", "sensor",   "rgb",      ""};

void check(const tensegric_fit::geometry::PointCloud& cloud) {
  tensegric_fit::fuzz::require(cloud.normals.empty() || cloud.normals.size() == cloud.points.size());
  tensegric_fit::fuzz::require(cloud.sensor.empty() || cloud.sensor.size() == cloud.points.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tensegric_fit;
  fuzz::Input input(data, size);
  pcl::PCLPointCloud2 cloud;
  for (std::uint32_t fields = input.number(1) % 13; fields > 0; --fields) {
    pcl::PCLPointField field;
    field.name = kNames[input.number(1) % kNames.size()];
    field.offset = input.any();
    field.datatype = static_cast<std::uint8_t>(input.number(1) % 11);
    field.count = input.any();
    cloud.fields.push_back(field);
  }
  cloud.width = input.any();
  cloud.height = input.any();
  cloud.point_step = input.any();
  cloud.row_step = input.number(1) % 2 != 0 ? cloud.point_step * cloud.width : input.any();
  cloud.is_bigendian = static_cast<std::uint8_t>(input.number(1) % 2);
  cloud.data = input.rest();
  fuzz::refused_or_done([&cloud] {
    const geometry::PointCloud points = geometry::points_of(cloud);
    check(points);
    geometry::PointCloud without_normals = points, without_sensors = points;
    without_normals.normals.clear();
    without_sensors.sensor.clear();
    check(geometry::joined({points, without_normals, without_sensors}));
    scan_files::apply({"mm", "y"}, cloud);  // a file of another unit
    fuzz::require(geometry::points_of(cloud).points.size() == points.points.size());
  });
  return 0;
}
