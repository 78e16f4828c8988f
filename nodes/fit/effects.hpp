/// What a garment is worn for, in figures: where the tips of the breasts and the buttocks went (P2 §4).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fit/chain.hpp"

namespace tensegric_fit::fit {

/// Heights of the bust points (bust_point_height: mean of both, above the soles) and of the buttocks,
/// and how far left and right are apart (bust_point_spread), before and after; metres, in the scan's posture.
/// What the body has no landmarks for is left out.
struct Effect {
  std::string name;
  double before, after;
};

std::vector<Effect> effects_of(const Body& body, const Fit& fit);

}  // namespace tensegric_fit::fit
