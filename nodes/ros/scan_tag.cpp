#include "ros/scan_tag.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace tensegric_fit::node {
namespace {

class Checksum {
 public:
  void add(const std::uint8_t* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ bytes[i]) * 16777619u;
  }
  void add(std::uint32_t number) {
    for (int shift = 0; shift < 32; shift += 8) {
      const auto byte = static_cast<std::uint8_t>(number >> shift);
      add(&byte, 1);
    }
  }
  std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 2166136261u;
};

}  // namespace

ScanTag tag_of(const sensor_msgs::PointCloud2& scan) {
  Checksum checksum;
  for (const std::uint32_t number : {scan.width, scan.height, scan.point_step, scan.row_step})
    checksum.add(number);
  for (const sensor_msgs::PointField& field : scan.fields) {
    checksum.add(reinterpret_cast<const std::uint8_t*>(field.name.data()), field.name.size());
    checksum.add(field.offset);
    checksum.add(field.datatype);
  }
  checksum.add(scan.data.data(), scan.data.size());

  ScanTag tag;
  tag.header = scan.header;
  if (tag.header.frame_id.empty()) tag.header.frame_id = "scan";
  tag.scan_id =
      fmt::format("{}.{:09}-{:08x}", scan.header.stamp.sec, scan.header.stamp.nsec, checksum.value());
  return tag;
}

}  // namespace tensegric_fit::node
