/// Shoulder points.
#pragma once

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

/// Of one side alone: a collarbone's length out from the neck's side, and half an arm's breadth beyond the
/// axilla, where these tell; behind the neck's side. Turns with the neck where the body stoops.
Shoulder find_shoulder(const BodyShape& body, const Trunk& trunk, const Neck& neck, Side side);

}  // namespace tensegric_fit::landmarks
