/// Arms that are held out to the sides.
#pragma once

#include "landmarks/armpit.hpp"

namespace tensegric_fit::landmarks {

struct RaisedArm {
  bool found = false;
  bool filled = false;  ///< the scan did not see the armpit: `roof` tells more, if found
  ArmpitRoof roof;
  Eigen::Vector3d axilla = Eigen::Vector3d::Zero();
  double abduction = 0;  ///< radians from straight down to the hand
};

/// An arm whose hand is held out by some 60 degrees or more. Level sections do not part such an arm from the
/// trunk at the armpit; sections that rise outwards, from trunk to arm, do.
RaisedArm find_raised_arm(const BodyShape& body, Side side);

}  // namespace tensegric_fit::landmarks
