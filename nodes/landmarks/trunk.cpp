#include "landmarks/trunk.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/arm_axis.hpp"
#include "landmarks/arm_cut.hpp"
#include "landmarks/gap.hpp"
#include "landmarks/raised_arm.hpp"

namespace tensegric_fit::landmarks {
namespace {

constexpr double kAxillaShare = 0.75;   // of stature, where no arm tells
constexpr double kHighestWaist = 0.70;  // of stature
constexpr double kWidestChest = 1.7;    // of the waist; what reaches further out is a forearm already
constexpr double kWidestGap =
    0.02;  // statures, of arm and trunk a fraction of a millimetre under the place where they join
constexpr double kRoundFilling = 0.015;  // skin round a filling, smoothed with it
constexpr double kInside = 0.0024;       // from where arm and trunk are narrowest to an armpit's roof
constexpr double kSeen = 1.0 / 3;  // of the place of an armpit that the scan saw: told by where they part
constexpr double kUpperArm = 0.02, kLowerArm = 0.05;  // statures under the axilla, between which the arm runs
constexpr double kForearm = 0.10;  // statures out from the trunk there: no upper arm, but what hangs from it
constexpr double kRaised = 0.98, kLevelArm = 1.4;  // radians; an arm without sections there

// The outline at a height that is the trunk of the nearest level, or -1.
int trunk_among(const std::vector<Outline>& outlines, const BodyLevels& levels, double height) {
  const Level& level = levels.levels[levels.nearest(height)];
  if (level.trunk < 0) return -1;
  const Eigen::Vector2d& middle = level.outlines[level.trunk].centroid;
  for (std::size_t i = 0; i < outlines.size(); ++i)
    if (contains(outlines[i], middle)) return static_cast<int>(i);
  return -1;
}

}  // namespace

Trunk::Trunk(const BodyShape& body) : body_(body) {
  for (Side side : {kLeft, kRight}) axillae_[side] = find_axilla(side);
}

std::vector<Outline> Trunk::outline_at(double height) const {
  const std::vector<Outline> outlines = body_.sliced.outlines_at(height);
  const int trunk = trunk_among(outlines, body_.levels, height);
  if (trunk < 0) return {};
  return {without_arms(outlines[trunk], body_.stature)};
}

std::vector<Outline> Trunk::outlines_with_breasts_at(double height) const {
  std::vector<Outline> result = outline_at(height);
  if (result.empty()) return result;
  const Outline trunk = result.front();
  for (const Outline& other : body_.sliced.outlines_at(height)) {
    const bool in_front = other.low.x() > trunk.centroid.x() && other.high.x() > trunk.high.x();
    const bool beside = other.centroid.y() > trunk.high.y() || other.centroid.y() < trunk.low.y();
    if (in_front && !beside) result.push_back(other);
  }
  return result;
}

double Trunk::axilla_height() const {
  if (axillae_[0].found && axillae_[1].found) return (axillae_[0].point.z() + axillae_[1].point.z()) / 2;
  for (const Axilla& axilla : axillae_)
    if (axilla.found) return axilla.point.z();
  return kAxillaShare * body_.stature;
}

void Trunk::under_filling(const ArmpitRoof& roof, Side side, Axilla& axilla) const {
  axilla.point = roof.middle;
  const ArmAxis arm = find_arm_axis(body_, {axilla.point, axilla.abduction, axilla.raised}, side);
  if (arm.found) axilla.point = lowest_of_roof(roof, arm.direction, body_.stature);
}

Axilla Trunk::find_axilla(Side side) const {
  Axilla axilla;
  if (const RaisedArm arm = find_raised_arm(body_, side); arm.found) {
    axilla.found = axilla.raised = true;
    axilla.filled = arm.filled;
    axilla.point = arm.axilla;
    axilla.abduction = arm.abduction;
    if (arm.roof.found) under_filling(arm.roof, side, axilla);
    return axilla;
  }
  // Going up, the trunk's section suddenly takes in the arm; the last such place is the axilla (a hand or an
  // elbow that touches the body comes before).
  const std::vector<Level>& levels = body_.levels.levels;
  const double jump = 0.02 * body_.stature;  // half the breadth of a slim arm
  // Where the arm has parted again, a hand or an elbow touched the trunk; where it has not, a forearm joins.
  const auto parted_between = [&](int first, int last) {
    const double joined = reach(levels[first].outlines[levels[first].trunk], side) + jump / 2;
    for (int i = first + 1; i < last; ++i)
      if (levels[i].trunk >= 0 && reach(levels[i].outlines[levels[i].trunk], side) < joined) return true;
    return false;
  };
  int below = -1;
  double waist = 1e9;
  for (int i = body_.levels.nearest(body_.crotch.height + 0.08 * body_.stature);
       i + 2 < static_cast<int>(levels.size()); ++i) {
    if (levels[i].height > 0.9 * body_.stature) break;
    if (levels[i].trunk < 0 || levels[i + 1].trunk < 0) continue;
    const Outline &here = levels[i].outlines[levels[i].trunk],
                  &above = levels[i + 1].outlines[levels[i + 1].trunk];
    if (levels[i].height < kHighestWaist * body_.stature) waist = std::min(waist, reach(here, side));
    if (reach(here, side) >= kWidestChest * waist || reach(above, side) - reach(here, side) <= jump) continue;
    if (below < 0 || parted_between(below, i)) below = i;
  }
  if (below < 0) return axilla;

  double low = levels[below].height, high = levels[below + 1].height;
  Outline trunk = levels[below].outlines[levels[below].trunk];
  const double narrow = reach(trunk, side);
  for (int halving = 0; halving < 12; ++halving) {
    const double z = (low + high) / 2;
    std::vector<Outline> outlines = body_.sliced.outlines_at(z);
    const int at = trunk_among(outlines, body_.levels, z);
    if (at >= 0 && reach(outlines[at], side) - narrow < jump / 2) {
      low = z;
      trunk = std::move(outlines[at]);
    } else {
      high = z;
    }
  }
  axilla.found = true;

  // An arm that hangs meets the trunk across a gap; a raised one grows out of the trunk's side.
  const auto inner_side = [side](const Outline& o) { return side == kLeft ? o.low.y() : -o.high.y(); };
  const auto arm_among = [&](const std::vector<Outline>& outlines) {
    const Outline* arm = nullptr;
    for (const Outline& outline : outlines)
      if (inner_side(outline) > narrow - jump && (arm == nullptr || inner_side(outline) < inner_side(*arm)))
        arm = &outline;
    return arm;
  };
  const std::vector<Outline> outlines = body_.sliced.outlines_at(low);
  const std::vector<Outline> upper = body_.sliced.outlines_at(low - kUpperArm * body_.stature),
                             bottom = body_.sliced.outlines_at(low - kLowerArm * body_.stature);
  const Outline *upper_arm = arm_among(upper), *bottom_arm = arm_among(bottom);
  axilla.abduction = kLevelArm;
  if (upper_arm != nullptr && bottom_arm != nullptr &&
      inner_side(*upper_arm) - narrow < kForearm * body_.stature)
    axilla.abduction = std::atan2(kSign[side] * (bottom_arm->centroid.y() - upper_arm->centroid.y()),
                                  (kLowerArm - kUpperArm) * body_.stature);
  axilla.raised = axilla.abduction > kRaised;
  if (gap_beside(trunk, outlines, side, kWidestGap * body_.stature, axilla.point)) {
    if (body_.filled.empty()) return axilla;
    // A scan's.
    axilla.filled = body_.unseen(axilla.point, kRoundFilling * body_.stature);
    const FilledArmpit hidden{body_.sliced, axilla.point, body_.stature};
    const Eigen::Vector3d seen = axilla.point;
    const ArmpitRoof roof = find_armpit_roof(hidden, axilla.filled ? height_of_roof(hidden) : seen.z(),
                                             -kSign[side] * kInside * body_.stature);
    if (roof.found) under_filling(roof, side, axilla);
    if (!axilla.filled) {  // a millimetre of noise moves the lowest place of so flat an arc by 15
      axilla.point = kSeen * seen + (1 - kSeen) * axilla.point;
      axilla.point.z() = seen.z();
    }
    return axilla;
  }
  // Where the skin under the arm turns from upright to level: the section's reach grows as fast as its
  // height.
  const auto turns_out = [&](int i) {
    return levels[i - 1].trunk >= 0 && reach(levels[i].outlines[levels[i].trunk], side) -
                                               reach(levels[i - 1].outlines[levels[i - 1].trunk], side) >
                                           body_.levels.step;
  };
  if (below > 0 && turns_out(below)) {
    while (below > 1 && turns_out(below - 1)) --below;
    trunk = levels[below].outlines[levels[below].trunk];
  }
  axilla.point = trunk.points.front();
  for (const Eigen::Vector3d& p : trunk.points)
    if (kSign[side] * p.y() > kSign[side] * axilla.point.y()) axilla.point = p;
  return axilla;
}

}  // namespace tensegric_fit::landmarks
