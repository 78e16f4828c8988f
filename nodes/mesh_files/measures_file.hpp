/// All heights and girths in one file: measures.json for programs, .vit for Valentina and other pattern
/// tools.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/moved_skin.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// A girth's way round the body, metres.
struct Loop {
  std::vector<Eigen::Vector3d> points;  ///< the tape, closed, without its first point again; body frame
  double tape = 0;  ///< its length: the hull of the section; worn, changed as that changes
  double skin = 0;  ///< along the skin inside the tape, into every hollow; 0: unknown
};

/// A height or girth before and under the garment, metres.
struct MeasureEntry {
  geometry::Measure before;
  bool is_girth = false;
  std::optional<double> worn;
  std::optional<Loop> loop, loop_worn;
  /// Of the neck's height: that of the landmark neck_back, which lies lower and is what pattern tools mean.
  std::optional<geometry::Measure> back{};
  std::optional<double> back_worn{};
};

/// A body under a garment. Holds references only. Metres, scan frame.
struct WornBody {
  const std::vector<Eigen::Vector3d>& skin;  ///< one per vertex of the body, in the scan's posture
  const std::vector<geometry::ChangedMeasure>&heights, &girths;
};

/// \param body scan frame \param worn null: measured only
std::vector<MeasureEntry> measure_entries(const geometry::TriangleMesh& body,
                                          const geometry::BodyMeasures& measures, const WornBody* worn);

/// measures.json, UTF-8 whatever the names hold.
std::string measures_text(const std::vector<MeasureEntry>& measures);

/// Valentina's individual measurements, cm; what it has no name for is left out. Figures with a confidence
/// below 0.5 are described as unsure, and listed in the notes: Valentina does not show descriptions of
/// measurements that it knows.
std::string measures_vit(const std::vector<MeasureEntry>& measures, bool worn);

}  // namespace tensegric_fit::mesh_files
