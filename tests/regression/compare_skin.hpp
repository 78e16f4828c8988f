/// Where on the body two runs differ.
#pragma once

#include <string>

#include "compare.hpp"

namespace tensegric_fit::regression {

struct RecordedScan {
  std::string bag, scan_id;
};

/// Adds the body at rest and under each garment, in their order; a note where messages are of another
/// version. \throw rosbag::BagException
void compare_skins(const RecordedScan& one, const RecordedScan& other, RunComparison& result);

}  // namespace tensegric_fit::regression
