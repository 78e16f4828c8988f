/// Where worn skin passes through other skin (README.md).
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "tffd/skin_place.hpp"

namespace tensegric_fit::tffd {

/// m: how far skin has to pass through skin to be said: what a scan's skin is off by.
inline constexpr double kLeastDepth = 1e-3;

/// Warnings `skin_crosses`, the deepest first: skin that moved and crosses other skin that faces it (smoothed
/// normals more than a right angle apart), or that it crosses. `value` is how far in a triangle there reaches
/// behind the one that it crosses, m: deeper in, triangles do not cross, so it is at least so deep. A place
/// in which skin crosses so deep at rest is left out: that is no body's skin. \pre one worn place a vertex
std::vector<geometry::FitWarning> check_crossings(const WornSkin& skin, const std::vector<WornLine>& lines);

}  // namespace tensegric_fit::tffd
