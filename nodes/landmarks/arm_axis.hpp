/// The way of an upper arm.
#pragma once

#include <vector>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

struct ArmAxis {
  bool found = false;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();      ///< on it
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, to the hand
};

/// Where to look for it.
struct ArmSearch {
  Eigen::Vector3d axilla;
  double abduction;  ///< radians from straight down, of a raised arm
  bool raised;
};

/// Through the middles of two sections square to it, where the arm has left the axilla behind. Not found
/// where the arm does not stand clear of the trunk there.
ArmAxis find_arm_axis(const BodyShape& body, const ArmSearch& search, Side side);

/// The loop of skin in a plane that runs round `origin` most nearly: its points, and the middle of the box
/// round them; false where none within `radius` closes.
bool loop_round(const BodyShape& body, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                double radius, std::vector<Eigen::Vector3d>& points, Eigen::Vector3d& middle);

}  // namespace tensegric_fit::landmarks
