#include "landmarks/shoulders.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/arm_axis.hpp"
#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;

// Statures. Bones do not grow with weight: out from the neck's side the acromion is a collarbone away. The
// middle of the shoulder's depth is taken so far below the shoulder's ridge.
constexpr double kCollarbone = 0.079, kBelowRidge = 0.030;
// So far behind that middle it lies: of stature, and of the arm's girth, as there is more flesh before it.
constexpr double kBehindMiddle = 0.0092, kFleshBefore = 0.055;
// Of stature: where there is no arm; and what a heavier arm has more hangs behind it.
constexpr double kUsualGirth = 0.165, kMostGirth = 0.19;
constexpr double kHanging = 22 * kDegree;
// By shares of how far the neck's side and the axilla are to the side; of stature, less a radian that the arm
// is raised; of the arm's girth.
constexpr double kNeck = 0.70, kAxilla = 0.22, kBeyond = 0.0422, kRises = 0.012, kFlesh = 0.172;
// Beyond the axilla alone, to the middle of the arm, and less as the arm is raised.
constexpr double kBeyondAxilla = 0.0222, kAxillaOpens = 0.0226;

// Radians from straight down to the upper arm, as its own axis tells, or else the sections below the axilla.
double raised_by(const BodyShape& body, const Axilla& axilla, Side side) {
  const ArmAxis arm = find_arm_axis(body, {axilla.point, axilla.abduction, axilla.raised}, side);
  return arm.found ? std::atan2(kSign[side] * arm.direction.y(), -arm.direction.z()) : axilla.abduction;
}

// How far the acromion lies to the side of `middle`, metres; negative where nothing tells. What one side
// lacks the other tells.
double half_breadth(const BodyShape& body, const Trunk& trunk, const Neck& neck, const ShoulderHints& hints,
                    double middle, Side side) {
  const double s = body.stature;
  double axillae = 0;
  int told = 0;
  for (Side other : {side, side == kLeft ? kRight : kLeft}) {
    const Axilla& axilla = trunk.axilla(other);
    if (!axilla.found) continue;
    const double aside = kSign[other] * (axilla.point.y() - middle);
    if (neck.found && hints.arm_girths[other] > 0)
      return kNeck * kSign[side] * (find_neck_side(body, neck, side).y() - middle) + kAxilla * aside +
             (kBeyond - kRises * (raised_by(body, axilla, other) - kHanging)) * s +
             kFlesh * hints.arm_girths[other];
    axillae += aside + (kBeyondAxilla - kAxillaOpens * (axilla.abduction - kHanging)) * s;
    ++told;
  }
  if (neck.found) return kSign[side] * (find_neck_side(body, neck, side).y() - middle) + kCollarbone * s;
  return told > 0 ? axillae / told : -1;
}

// The acromion on the sagittal section of a shoulder, whose ridge lies near `place`, `behind` metres behind
// its middle; false where there is no
// shoulder.
bool on_section(const BodyShape& body, const Vector3d& place, double stoop, double behind, Vector3d& point) {
  const double s = body.stature;
  const Vector3d reach = Vector3d(0.13, 0.03, 0.16) * s;
  const std::vector<geometry::SectionLoop> section =
      cut(body, triangles_in_box(body, place - reach, place + reach), place, Vector3d::UnitY());
  double ridge = -1e9, front = -1e9, back = 1e9;
  for (const geometry::SectionLoop& loop : section)
    for (const Vector3d& p : loop.points)
      if (std::abs(p.x() - place.x()) < 0.08 * s) ridge = std::max(ridge, p.z());
  for (const geometry::SectionLoop& loop : section) {
    for (const Vector3d& p : loop.points) {
      if (std::abs(p.z() - ridge + kBelowRidge * s) > 0.005 * s) continue;
      front = std::max(front, p.x());
      back = std::min(back, p.x());
    }
  }
  if (front <= back) return false;
  const double x = (front + back) / 2 + kBelowRidge * s * std::sin(stoop) - behind * std::cos(stoop);
  double top = -1e9;
  for (const geometry::SectionLoop& loop : section)
    for (std::size_t i = loop.closed ? 0 : 1; i < loop.points.size(); ++i) {
      const Vector3d &a = loop.points[(i == 0 ? loop.points.size() : i) - 1], &b = loop.points[i];
      if ((a.x() > x) != (b.x() > x))
        top = std::max(top, a.z() + (b.z() - a.z()) * (x - a.x()) / (b.x() - a.x()));
    }
  point = {x, place.y(), top};
  return top > ridge - 2 * kBelowRidge * s;
}

}  // namespace

Shoulder find_shoulder(const BodyShape& body, const Trunk& trunk, const Neck& neck,
                       const ShoulderHints& hints, Side side) {
  const double s = body.stature;
  const Axilla &left = trunk.axilla(kLeft), &right = trunk.axilla(kRight);
  Shoulder shoulder;
  if (!neck.found && !(left.found && right.found)) {
    shoulder.reason = "neither neck nor arms tell where it is";
    return shoulder;
  }
  Vector3d place;
  if (neck.found) {
    const Vector3d base[2] = {find_neck_side(body, neck, kLeft), find_neck_side(body, neck, kRight)};
    place = base[side] - 0.04 * s * Vector3d::UnitZ();
    place.y() = (base[0].y() + base[1].y()) / 2;
  } else {
    place = (left.point + right.point) / 2 + 0.055 * s * Vector3d::UnitZ();
    shoulder.confidence = 0.4;
    shoulder.reason = "no neck; judged by the axillae alone";
  }
  const double breadth = half_breadth(body, trunk, neck, hints, place.y(), side);
  place.y() += kSign[side] * breadth;
  const double girth =
      hints.arm_girths[side] > 0 ? std::min(hints.arm_girths[side], kMostGirth * s) : kUsualGirth * s;
  shoulder.found = breadth > 0 && on_section(body, place, neck.found ? hints.stoop : 0,
                                             kBehindMiddle * s + kFleshBefore * girth, shoulder.point);
  if (!shoulder.found) shoulder.reason = "no skin over the end of the collarbone";
  return shoulder;
}

}  // namespace tensegric_fit::landmarks
