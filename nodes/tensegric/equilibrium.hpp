/// The equilibrium solver: least energy at constant volumes under the bands (README.md).
#pragma once

#include "tensegric/problem.hpp"

namespace tensegric_fit::tensegric {

/// Follows the load in steps from rest, or from an earlier solution that came to a balance. Leaves the
/// problem's apexes at the share of the posture that was reached.
Outcome find_equilibrium(Problem& problem, const Solution* start, Recorder& recorder);

}  // namespace tensegric_fit::tensegric
