#include "assembler/shared_frames.hpp"

#include <fmt/format.h>

#include <map>

namespace tensegric_fit::assembler {
namespace {

constexpr const char* kBooth = "booth";  // default of the assembler's frame_id

}  // namespace

std::vector<SharedFrame> shared_frames(const Capture& capture, const std::string& scan_frame) {
  std::map<std::string, std::vector<int>> sensors_in;
  for (std::size_t sensor = 0; sensor < capture.clouds.size(); ++sensor)
    if (const auto& cloud = capture.clouds[sensor])
      sensors_in[cloud->frame_id].push_back(static_cast<int>(sensor));
  const bool is_booths = scan_frame.substr(scan_frame.rfind('/') + 1) == kBooth;
  std::vector<SharedFrame> shared;
  for (const auto& [frame_id, sensors] : sensors_in) {
    const bool of_scan = frame_id == scan_frame;
    if ((of_scan && is_booths) || sensors.size() > 1) shared.push_back({frame_id, of_scan, sensors});
  }
  return shared;
}

std::string warning_of(const std::vector<SharedFrame>& shared, const std::vector<std::string>& topics) {
  if (shared.empty()) return "";
  std::vector<std::string> places;
  for (const SharedFrame& frame : shared) {
    std::string names;
    for (std::size_t i = 0; i < frame.sensors.size(); ++i) {
      if (i > 0) names += i + 1 < frame.sensors.size() ? ", " : " and ";
      names += topics[frame.sensors[i]];
    }
    places.push_back(fmt::format("clouds of {} are in {} ({})", names,
                                 frame.of_scan ? "the scan's own frame" : "one frame", frame.frame_id));
  }
  return fmt::format("{}: where their sensors stood is unknown, normals are left out",
                     fmt::join(places, ", "));
}

}  // namespace tensegric_fit::assembler
