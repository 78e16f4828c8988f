/// A case of one's own from a recorded bag.
#pragma once

#include <string>
#include <vector>

#include "harness.hpp"

namespace tensegric_fit::regression {

struct RecordRequest {
  std::string bag;    ///< with a scan, or the clouds of a booth's sensors; garments in it are worn
  std::string name;   ///< of the case
  std::string cases;  ///< folder of the case files
  std::string about;  ///< a sentence; empty: says where it was recorded
  std::vector<std::string> garments;  ///< names of shipped ones, in place of the bag's; `none`: measure only
  int scan = 1;                       ///< which of several scans
};

/// Writes CASES/NAME.yaml without expectations yet and CASES/bags/NAME.bag with the scan, sensors' places,
/// and the bag's garments where they are no shipped ones. \throw Refusal bad_case: the case is there already,
/// or the name is no name of a file; broken_file: no such scan, or no bag; bad_garment; rosbag::BagException
void write_case_input(const RecordRequest& request);

/// Runs it by the bag runner, and adds everything found as golden values, with a tolerance by kind and its
/// reason; records its shape. \throw as run_bag; Refusal bad_case. The case is removed then
Outcome add_everything_found(const RecordRequest& request, const HarnessOptions& options);

/// The lines of `metrics:` for what was found: times and memory are of the run, and left out.
std::string metric_lines(const Metrics& metrics);

}  // namespace tensegric_fit::regression
