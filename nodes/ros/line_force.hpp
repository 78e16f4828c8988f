/// How hard a line pulls and presses, in calibrated units.
#pragma once

#include <tensegric_fit/FitState.h>
#include <tensegric_fit/LineForces.h>

#include <optional>

namespace tensegric_fit::node {

struct LineForce {
  double newtons;
  double kilopascals;  ///< largest normal pressure; 0 of a string
};

/// Of line `line` of the fit. Nothing where the forces are of another fit, or were not calibrated.
std::optional<LineForce> force_of(const LineForces& forces, const FitState& fit, std::size_t line);

}  // namespace tensegric_fit::node
