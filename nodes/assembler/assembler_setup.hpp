/// Parameters of the assembler node.
#pragma once

#include <string>
#include <vector>

#include "assembler/assembler.hpp"
#include "assembler/capture_join.hpp"
#include "ros/parameters.hpp"

namespace tensegric_fit::node {

struct AssemblerSetup {
  std::vector<std::string> sensors;  ///< topics, column by column
  std::string frame_id;              ///< of the scan
  int min_sensors;                   ///< with fewer, a capture is refused
  assembler::CaptureOptions capture;
  assembler::AssemblerOptions assembler;
};

/// \throw Refusal bad_option naming the parameter
AssemblerSetup assembler_setup(Parameters parameters);

}  // namespace tensegric_fit::node
