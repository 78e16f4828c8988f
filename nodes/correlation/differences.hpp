/// What was measured before, on the simulated body and on the worn scan, side by side.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/moved_skin.hpp"

namespace tensegric_fit::correlation {

/// Metres; nothing where it was not found.
struct Difference {
  std::string name;
  double before;
  std::optional<double> simulated, worn;
  double confidence;   ///< the least of the three
  std::string reason;  ///< of a confidence below 0.5
};

/// Girths, and heights above the soles: those of the worn body above the soles before, as it was aligned, so
/// that feet that stand otherwise do not count; stature above her own. Effects: bust_point_height and
/// buttock_height, mean of left and right, and bust_point_spread and buttock_spread, from left to right.
struct Differences {
  std::vector<Difference> effects, girths, heights;
};

/// m: a figure that is found that far from where the simulation carried it is not the same figure any more,
/// as a level of greatest girth beside a band that cuts in. The widest that ISO 20685-1:2018 allows of a
/// measure.
inline constexpr double kElsewhere = 9e-3;

/// The same measurement on three bodies; null where one could not be measured. `before` and `simulated` are
/// in one frame, to which `simulated_from_worn` takes the worn one's. On the simulated body it is known how
/// each figure changes, by its `skin`: one that is found kElsewhere from there has that for `simulated` and
/// nothing for `worn`, on which it would be found as wrongly.
Differences differences_of(const geometry::BodyMeasures& before, const geometry::MovedSkin& skin,
                           const geometry::BodyMeasures* simulated, const geometry::BodyMeasures& worn,
                           const Eigen::Isometry3d& simulated_from_worn);

}  // namespace tensegric_fit::correlation
