#include "landmarks/armpit.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

// Statures.
constexpr double kLower = 0.01, kHigher = 0.06;  // about the parting: where to look for the root
constexpr double kBeside = 0.02;                 // what joins arm and trunk is as near as that to the parting
constexpr double kOneWithTrunk = 0.015;          // further up the arm is
constexpr double kDome = 0.0066;  // an armpit is a dome of 11 mm, whether its owner is slim or heavy
constexpr double kNarrow = 0.0012, kMiddle = 0.012;  // over the roof: where its side and its middle are told
constexpr double kUncertain = 0.028;                 // radians: as far off the way of an arm may be
constexpr double kRadius = 0.125;                    // of the roof's middle, front to back
// Shares: of its length further up, what joins arm and trunk has a dome's height above a roof; of the roof's
// depth, nearer to its middle than that its lowest place stays: its ends, the folds before and behind the
// armpit, are steep.
constexpr double kAtOnce = 0.7, kFurthest = 0.33;
// Of what the lowest place lies further forward: it is that much higher. Where the front is lowest, the
// filling hides the high end behind.
constexpr double kHigherInFront = 0.12;
constexpr double kParting =
    1.0 / 3;  // of the roof's side: told by the filling, which follows the skin beside it

Bridge bridge_at(const FilledArmpit& armpit, double height) {
  const double beside = kBeside * armpit.stature;
  return narrowest_bridge(armpit.sliced.outlines_at(height), armpit.parting.y() - beside,
                          armpit.parting.y() + beside);
}

}  // namespace

double height_of_roof(const FilledArmpit& armpit) {
  const double s = armpit.stature, z = armpit.parting.z(), y = armpit.parting.y();
  const Root root =
      find_root(armpit.sliced, {z - kLower * s, z + kHigher * s, y - kBeside * s, y + kBeside * s, 0},
                kOneWithTrunk * s);
  return root.found ? std::max(root.height - kDome * s, z) : z;
}

bool parting_is_roof(const FilledArmpit& armpit) {
  const double over = armpit.parting.z() + kDome * armpit.stature;
  return bridge_at(armpit, over).length >
         kAtOnce * bridge_at(armpit, over + kOneWithTrunk * armpit.stature).length;
}

ArmpitRoof find_armpit_roof(const FilledArmpit& armpit, double height, double aside) {
  const Bridge narrow = bridge_at(armpit, height + kNarrow * armpit.stature),
               middle = bridge_at(armpit, height + kMiddle * armpit.stature);
  const double y = (1 - kParting) * narrow.y + kParting * armpit.parting.y() + aside;
  return {narrow.length > 0 && middle.length > 0,
          {(middle.front + middle.back) / 2, y, height},
          middle.front - middle.back};
}

Eigen::Vector3d lowest_of_roof(const ArmpitRoof& roof, const Eigen::Vector3d& arm, double stature) {
  // As an arm swings the roof tilts; one that is held out rather turns it. What is no more than a scan's
  // noise or a motion fracture makes of an arm's way counts little.
  const double told = std::asin(std::clamp(-arm.x(), -1.0, 1.0)) * (1 + std::max(-arm.z(), 0.0)) / 2,
               tilt = told * told * told / (told * told + kUncertain * kUncertain),
               furthest = std::max(kFurthest * roof.depth, 1e-9);
  const double forward = furthest * std::tanh(kRadius * stature * tilt / furthest);
  return roof.middle + forward * Eigen::Vector3d(1, 0, kHigherInFront);
}

}  // namespace tensegric_fit::landmarks
