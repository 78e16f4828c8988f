/// Shoulder points.
#pragma once

#include "landmarks/neck.hpp"
#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

struct Shoulders {
  bool found = false;
  Eigen::Vector3d points[2] = {Eigen::Vector3d::Zero(),
                               Eigen::Vector3d::Zero()};  ///< left, right: the acromia, as the skin over them
};

/// Both at the same distance from the neck's middle: half the breadth that slopes and axillae of both sides
/// tell.
Shoulders find_shoulders(const BodyShape& body, const Trunk& trunk, const Neck& neck);

}  // namespace tensegric_fit::landmarks
