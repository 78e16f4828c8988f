/// Where the arms are: of all parts they may be farthest from where the mean woman has them.
#pragma once

#include "body_model/matching.hpp"
#include "body_model/posed_model.hpp"

namespace tensegric_fit::body_model {

/// Sets each arm, trunk and all else as it is, to the one of many poses in which its skin is nearest to the
/// samples.
Parameters with_arms_placed(const Model& model, const Matcher& matcher, const Parameters& parameters);

}  // namespace tensegric_fit::body_model
