/// Lines of a garment that the skin comes through.
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "tffd/skin_place.hpp"

namespace tensegric_fit::tffd {

/// One `skin_over_line` a line that lies, somewhere, by kOffSkin deeper in the worn skin than it does
/// anywhere at rest, in the garment's order; `value`: how deep, m. A taut line hangs on the skin that it
/// touches at rest, and skin beside that is not held by it. `vertices`: the skin within 15 mm of where it is
/// that deep. `skin.rest`: in the scan's posture, where the lines' courses at rest are. \throw Refusal
/// bad_mesh: not one worn place a vertex
std::vector<geometry::FitWarning> skin_over_lines(const WornSkin& skin, const std::vector<WornLine>& lines);

}  // namespace tensegric_fit::tffd
