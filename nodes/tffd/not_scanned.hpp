/// Lines of a garment over skin that no scan saw.
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "tffd/skin_place.hpp"

namespace tensegric_fit::tffd {

/// A line of which more than this share lies over skin that was not scanned (definition: most of it).
inline constexpr double kMostlyNotScanned = 0.5;

/// One `not_scanned` a line that is, in the garment's order; `value`: the share. `vertices`: that skin within
/// 15 mm of the line. `filled`: empty, or one flag per vertex, 1 where the scan saw nothing. `skin.rest`: in
/// the scan's posture, where the lines' courses at rest are.
/// \throw Refusal bad_mesh: not one worn place, or not one flag, per vertex
std::vector<geometry::FitWarning> not_scanned(const WornSkin& skin, const std::vector<char>& filled,
                                              const std::vector<WornLine>& lines);

}  // namespace tensegric_fit::tffd
