/// Clouds whose frame does not say where their sensor stood.
#pragma once

#include <string>
#include <vector>

#include "assembler/capture_join.hpp"

namespace tensegric_fit::assembler {

/// A frame of several sensors' clouds, or a booth's: its origin is no sensor's viewpoint. Where calibrations
/// are relative to one of the sensors the scan is in that one's frame, and it alone.
struct SharedFrame {
  std::string frame_id;
  bool of_scan;
  std::vector<int> sensors;
};

/// Those of a capture, by name. `scan_frame`: of the scan that it becomes; a booth's where it is called so,
/// in any namespace.
std::vector<SharedFrame> shared_frames(const Capture& capture, const std::string& scan_frame);

/// A warning that names the topics, of which there is one per sensor; empty where no frame is shared.
std::string warning_of(const std::vector<SharedFrame>& shared, const std::vector<std::string>& topics);

}  // namespace tensegric_fit::assembler
