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

/// Out from the middle of the neck by a collarbone's length beyond its side, and by what the axillae tell of
/// the shoulders' breadth; behind the middle of the shoulder's own depth, further forward the more the upper
/// back stoops: by `stoop` radians, as stoop_of tells.
Shoulder find_shoulder(const BodyShape& body, const Trunk& trunk, const Neck& neck, double stoop, Side side);

}  // namespace tensegric_fit::landmarks
