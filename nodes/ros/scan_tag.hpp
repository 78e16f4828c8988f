/// Which scan a message belongs to.
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include <string>

namespace tensegric_fit::node {

/// Stamp, frame and id of a scan: every message of a chain carries the three of the scan that it comes from.
struct ScanTag {
  std_msgs::Header header;
  std::string scan_id;
};

/// "<sec>.<nsec>-<8 hex digits>": the stamp and a checksum (FNV-1a) of layout and data. The same scan always
/// gets the same id. A scan without a frame is given the frame "scan", since tf refuses an empty one.
ScanTag tag_of(const sensor_msgs::PointCloud2& scan);

/// The tag that a message carries.
template <typename Message>
ScanTag tag_in(const Message& message) {
  return {message.header, message.scan_id};
}

}  // namespace tensegric_fit::node
