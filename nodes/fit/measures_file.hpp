/// All heights and girths in one file: measures.json for programs, .vit for Valentina and other pattern
/// tools.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fit/chain.hpp"

namespace tensegric_fit::fit {

/// A girth's way round the body, metres.
struct Loop {
  std::vector<Eigen::Vector3d> points;  ///< the tape, closed, without its first point again; body frame
  double tape = 0;                      ///< its length: the hull of the section
  double skin = 0;                      ///< along the skin inside the tape, into every hollow; 0: unknown
};

/// A height or girth before and under the garment, metres.
struct MeasureEntry {
  geometry::Measure before;
  bool is_girth = false;
  std::optional<double> worn;
  std::optional<Loop> loop, loop_worn;
};

/// \param fit null: measured only
std::vector<MeasureEntry> measure_entries(const Body& body, const Fit* fit);

nlohmann::ordered_json measures_json(const std::vector<MeasureEntry>& measures);

/// Valentina's individual measurements, cm; what it has no name for is left out.
std::string measures_vit(const std::vector<MeasureEntry>& measures, bool worn);

}  // namespace tensegric_fit::fit
