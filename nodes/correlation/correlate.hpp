/// Simulation against reality: the simulated body compared with a scan of the person in the garment (P2 §6,
/// Fig. 12).
#pragma once

#include "correlation/align.hpp"
#include "correlation/distance_map.hpp"
#include "correlation/likeness.hpp"
#include "correlation/skin_parts.hpp"
#include "geometry/range.hpp"

namespace tensegric_fit::correlation {

inline constexpr geometry::Range kThickness{0, 0.03};  ///< m, of a garment

/// m; a garment moves tissue, and adds none: half of what it covers is never that far outside the simulation.
inline constexpr double kThickCloth = 0.012;

/// Field defaults are the parameters' defaults.
struct Options {
  double thickness = 0;  ///< m, of the garment, over the skin that it covers (SkinPart)
};

struct Correlation {
  Alignment alignment;  ///< patch_from_scan takes the worn scan's frame to the simulated body's
  Likeness likeness;
  std::vector<SkinPart> parts;  ///< one per vertex of the simulated body
  DistanceMap map;
  Summary covered, still;
  double compared = 0;  ///< compared_share
};

/// Aligns the worn scan on the still skin, makes sure that it is the same person in the same pose, and
/// measures how far it lies from the simulated body. \throw Refusal as check, parts_of, check_same and
/// SeenSurface; coat_on: the covered skin lies kThickCloth outside; too_few_data: less than half of the skin
/// under the garment can be compared, or the still skin does not fix the position; bad_option: the thickness
/// is out of range
Correlation correlate(const SimulatedBody& body, const WornBody& worn, const Options& options);

}  // namespace tensegric_fit::correlation
