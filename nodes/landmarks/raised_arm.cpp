#include "landmarks/raised_arm.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/gap.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;

// Statures, of shoulder and armpit: to the side and up.
constexpr double kShoulderSide = 0.10, kShoulderHeight = 0.80;
constexpr double kArmpitSide = 0.09, kArmpitHeight = 0.75;
constexpr double kLowestHand = 0.45,
                 kNearestHand = 0.25;  // statures: up, and to the side; a trunk stays within
constexpr double kRaised = 60 * kDegree;
// Sections rise outwards by 20 degrees, as the place that parts hanging arm and trunk turns with the arm; by
// more for a hand over the shoulder, so that they rise more steeply than the skin under the arm.
constexpr double kRise = 20 * kDegree, kLevelHand = 85 * kDegree, kRiseWithHand = 0.3;
constexpr double kUnder = 0.10, kOver = 0.12, kApart = 0.004;  // statures about the armpit: where to look
constexpr double kJoins = 0.03;  // statures by which a section reaches further where it takes in the arm
constexpr double kWidestGap = 0.03;
constexpr double kRoundFilling = 0.015;  // skin round a filling, smoothed with it
constexpr double kBackwards = 0.0018;    // a raised arm takes the roof's middle along
constexpr int kHalvings = 12;

// Turns the side up and inwards about the axis that points forward.
Eigen::Matrix3d risen(double angle, Side side) {
  return Eigen::AngleAxisd(-kSign[side] * angle, Vector3d::UnitX()).toRotationMatrix();
}

// Furthest out of what is higher than a hanging hand.
Vector3d hand_of(const BodyShape& body, Side side) {
  Vector3d hand = Vector3d::Zero();
  for (const Vector3d& p : body.mesh.vertices)
    if (p.z() > kLowestHand * body.stature && kSign[side] * p.y() > kSign[side] * hand.y()) hand = p;
  return hand;
}

}  // namespace

RaisedArm find_raised_arm(const BodyShape& body, Side side) {
  const double s = body.stature;
  const Vector3d hand = hand_of(body, side);
  RaisedArm arm;
  arm.abduction = std::atan2(kSign[side] * hand.y() - kShoulderSide * s, kShoulderHeight * s - hand.z());
  if (arm.abduction < kRaised || kSign[side] * hand.y() < kNearestHand * s) return arm;

  // Level sections of the body turned the other way.
  const double rise = kRise + kRiseWithHand * std::max(0.0, arm.abduction - kLevelHand);
  const Eigen::Matrix3d turn = risen(rise, side);
  geometry::TriangleMesh turned = body.mesh;
  for (Vector3d& v : turned.vertices) v = turn * v;
  const SlicedMesh sliced(turned);
  const Level& chest = body.levels.levels[body.levels.nearest(kArmpitHeight * s - kUnder * s)];
  if (chest.trunk < 0) return arm;
  const double chest_x = chest.outlines[chest.trunk].centroid.x();
  const auto trunk_at = [&](double z, std::vector<Outline>& outlines) {
    outlines = sliced.outlines_at(z);
    const Eigen::Vector2d middle(chest_x, kSign[side] * z * std::tan(rise));
    return std::find_if(outlines.begin(), outlines.end(),
                        [&](const Outline& o) { return contains(o, middle); });
  };

  const double armpit = (turn * Vector3d(0, kSign[side] * kArmpitSide * s, kArmpitHeight * s)).z();
  double low = 0, high = 0, narrow = -1;
  std::vector<Outline> outlines;
  for (double z = armpit - kUnder * s; z < armpit + kOver * s; z += kApart * s) {
    const auto trunk = trunk_at(z, outlines);
    if (trunk == outlines.end()) continue;
    high = z;
    if (narrow > 0 && reach(*trunk, side) - narrow > kJoins * s) break;
    low = z;
    narrow = reach(*trunk, side);
  }
  if (low == high) return arm;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double z = (low + high) / 2;
    const auto trunk = trunk_at(z, outlines);
    (trunk != outlines.end() && reach(*trunk, side) - narrow < kJoins / 2 * s ? low : high) = z;
  }
  const auto trunk = trunk_at(low, outlines);
  Vector3d middle = Vector3d::Zero();
  arm.found = trunk != outlines.end() && gap_beside(*trunk, outlines, side, kWidestGap * s, middle);
  if (!arm.found) return arm;
  arm.axilla = turn.transpose() * middle;
  arm.filled = body.unseen(arm.axilla, kRoundFilling * s);
  if (!arm.filled) return arm;
  const FilledArmpit hidden{sliced, middle, s};
  arm.roof = find_armpit_roof(hidden, parting_is_roof(hidden) ? middle.z() : height_of_roof(hidden), 0);
  arm.roof.middle = turn.transpose() * arm.roof.middle - kBackwards * s * Vector3d::UnitX();
  return arm;
}

}  // namespace tensegric_fit::landmarks
