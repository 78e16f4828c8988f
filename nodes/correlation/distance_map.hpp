/// How far a worn scan lies from the simulated body.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "correlation/seen_surface.hpp"
#include "correlation/skin_parts.hpp"

namespace tensegric_fit::correlation {

/// One value per vertex of the simulated body.
struct DistanceMap {
  std::vector<double> distance;  ///< m; positive: the worn surface lies outside; 0 where nothing is compared
  /// 0: a mobile part, or either scan saw no skin there, or the worn one none that faces alike
  std::vector<char> compared;
};

inline constexpr double kFarthest = 0.10;  ///< m; what lies farther off is another part of the body

/// From each vertex of the deformed body, moved out along its normal by `thickness` (m) where it is covered,
/// to the nearest place of the scan as `simulated_from_worn` lays it.
DistanceMap distance_map(const SimulatedBody& body, const std::vector<SkinPart>& parts,
                         const SeenSurface& worn, const Eigen::Isometry3d& simulated_from_worn,
                         double thickness);

/// Distances of some skin, weighed by its area; metres. All 0 where `compared` is 0.
struct Summary {
  double mean = 0, median = 0;             ///< signed
  double mean_size = 0, rms = 0, p95 = 0;  ///< of the distances without their signs
  double compared = 0;                     ///< share of the skin's area, 0 to 1
};

/// Over the vertices of that part.
Summary summary_of(const DistanceMap& map, const SimulatedBody& body, const std::vector<SkinPart>& parts,
                   SkinPart part);

/// Share of the covered skin that the garment moved, by area, that is compared: 0 to 1. Where it moved none,
/// of all that is covered.
double compared_share(const DistanceMap& map, const SimulatedBody& body, const std::vector<SkinPart>& parts);

}  // namespace tensegric_fit::correlation
