/// Worn skin, lines on it, and places of it that there is something to say of.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "geometry/fit_warning.hpp"

namespace tensegric_fit::tffd {

/// m: a line that is farther than this from a place has no part in it (a hand's breadth).
inline constexpr double kNearLine = 0.10;

/// A garment line as it lies on a body, scan frame, metres; tension in the solver's pseudo force.
struct WornLine {
  std::string name;
  std::vector<Eigen::Vector3d> at_rest, worn;  ///< its middle thread, point by point
  double neutral = 0, final = 0;               ///< lengths
  double tension = 0;
};

/// A body's skin before and after, one place per vertex. `rest` in the posture in which it is worn, so that a
/// posture turns nothing. Only borrowed. Metres, scan frame.
struct WornSkin {
  const std::vector<Eigen::Vector3d>& rest;
  const std::vector<Eigen::Vector3d>& worn;
  const std::vector<Eigen::Vector3i>& triangles;
  const std::vector<Eigen::Vector3d>* scanned = nullptr;  ///< in the scan's posture; null: `rest`
};

/// Triangles connected by their corners, or by `joined`: one list a place, of numbers in `picked`, ascending;
/// places in the order of their first. `joined`: pairs of numbers in `picked`.
std::vector<std::vector<int>> places_of(const std::vector<int>& picked,
                                        const std::vector<Eigen::Vector3i>& triangles,
                                        const std::vector<std::pair<int, int>>& joined = {});

/// Gives a new warning its place: area, middle as scanned and as worn, vertices of these triangles.
void take_place(const std::vector<int>& triangles, const WornSkin& skin, geometry::FitWarning& warning);

/// A warning of these triangles: its place and the nearest line.
geometry::FitWarning warning_at(const char* code, const std::vector<int>& triangles, double value,
                                const WornSkin& skin, const std::vector<WornLine>& lines);

}  // namespace tensegric_fit::tffd
