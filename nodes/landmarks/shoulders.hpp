/// Shoulder points.
#pragma once

#include <array>
#include <string>

#include "landmarks/neck.hpp"
#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

/// The acromion, as the skin over it.
struct Shoulder {
  bool found = false;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double confidence = 0.9;
  std::string reason;  ///< of a low confidence, or why it was not found
};

/// What else tells where the shoulders are.
struct ShoulderHints {
  double stoop = 0;                        ///< radians, as stoop_of tells
  std::array<double, 2> arm_girths{0, 0};  ///< metres, of the upper arms; 0 where there is none
};

/// Out from the middle of the neck as the neck's own breadth, the axilla, a collarbone's length and the flesh
/// over the bone tell, the last by the arm's girth; behind the middle of the shoulder's own depth, the more the
/// heavier the arm is, and further forward the more the upper back stoops.
Shoulder find_shoulder(const BodyShape& body, const Trunk& trunk, const Neck& neck,
                       const ShoulderHints& hints, Side side);

}  // namespace tensegric_fit::landmarks
