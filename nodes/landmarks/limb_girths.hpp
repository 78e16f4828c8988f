/// Girths square to arms and legs.
#pragma once

#include <string>
#include <vector>

#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

struct LimbGirth {
  std::vector<Eigen::Vector3d> tape;  ///< empty where there is none
  double confidence = 0.8;
  std::string reason;  ///< of a low confidence, or why there is none
};

/// Round the upper arm, square to it, 0.051 statures below the axilla along it. \pre axilla.found
LimbGirth find_upper_arm_girth(const BodyShape& body, const Axilla& axilla, Side side);

/// Round the thigh, square to it, 0.039 statures below the crotch; of thighs that touch, round a half of
/// both.
LimbGirth find_thigh_girth(const BodyShape& body, Side side);

}  // namespace tensegric_fit::landmarks
