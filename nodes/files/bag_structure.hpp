/// Whether a file is a rosbag that rosbag's own reader can be given, and where its scans are.
#pragma once

#include <string>

namespace tensegric_fit::files {

/// Debian's rosbag (1.15) believes the lengths, offsets and counts that a file states, and reads beyond its
/// buffers where they lie. Checks all of them, through all records and chunks (bag format 2.0, wiki.ros.org);
/// messages themselves are checked by whoever reads them. A bag without an index, as a recording that was cut
/// off leaves it, passes: rosbag names it. \throw Refusal broken_file naming file and record
void check_bag_structure(const std::string& path);

/// Whether scans are on that topic of a bag: scan/points, in any namespace.
bool is_scan_topic(const std::string& topic);

}  // namespace tensegric_fit::files
