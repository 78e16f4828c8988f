#include "landmarks/shoulders.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;

// Statures. Bones do not grow with weight: out from the neck's side the acromion is a collarbone away, and it
// lies behind the middle of the shoulder's depth, taken so far below the shoulder's ridge.
constexpr double kCollarbone = 0.079, kBelowRidge = 0.030, kBehindMiddle = 0.0183;
constexpr double kHanging = 22 * kDegree;
// Beyond the neck's side and the axilla, by their shares: of stature, less a radian that the arm is raised,
// and of the arm's girth.
constexpr double kNeck = 0.8, kBeyond = 0.0434, kRises = 0.0133, kFlesh = 0.152;
// Beyond the axilla alone, to the middle of the arm, and less as the arm is raised.
constexpr double kBeyondAxilla = 0.0222, kAxillaOpens = 0.0226;

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
    const double aside = kSign[other] * (axilla.point.y() - middle), raised = axilla.abduction - kHanging;
    if (neck.found && hints.arm_girths[other] > 0)
      return kNeck * kSign[side] * (find_neck_side(body, neck, side).y() - middle) + (1 - kNeck) * aside +
             (kBeyond - kRises * raised) * s + kFlesh * hints.arm_girths[other];
    axillae += aside + (kBeyondAxilla - kAxillaOpens * raised) * s;
    ++told;
  }
  if (neck.found) return kSign[side] * (find_neck_side(body, neck, side).y() - middle) + kCollarbone * s;
  return told > 0 ? axillae / told : -1;
}

// The acromion on the sagittal section of a shoulder, whose ridge lies near `place`; false where there is no
// shoulder.
bool on_section(const BodyShape& body, const Vector3d& place, double stoop, Vector3d& point) {
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
  const double x = (front + back) / 2 + (kBelowRidge * std::sin(stoop) - kBehindMiddle * std::cos(stoop)) * s;
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
  shoulder.found = breadth > 0 && on_section(body, place, neck.found ? hints.stoop : 0, shoulder.point);
  if (!shoulder.found) shoulder.reason = "no skin over the end of the collarbone";
  return shoulder;
}

}  // namespace tensegric_fit::landmarks
