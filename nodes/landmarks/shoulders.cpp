#include "landmarks/shoulders.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// Statures. Bones do not grow with weight: from the neck's side to the acromion it is as far on thin and on
// heavy bodies.
constexpr double kFromNeckOut = 0.080, kFromNeckBack = 0.027, kFromNeckDown = 0.043;
constexpr double kRaisedFromNeckOut = 0.075;  // the collarbone goes up with a raised arm
constexpr double kBeyondAxilla = 0.0225;      // over the middle of the arm
constexpr double kBoneTells = 2.0 / 3;        // its share; the rest is what axilla and slope tell in the mean

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kApart = 0.005;           // m, between two places of the ridge
constexpr int kReach = 4;                  // places each way over which its slope is taken: 20 mm
constexpr double kSlopeAtAcromion = 0.81;  // 39 degrees: where the shoulder's line turns down into the arm
constexpr double kFlat = 0.3;

// The line from the neck's back down the upper back, over so much of it, leans forward by this on an upright
// body: a heavier one, told by its neck, has more on its neck. A stoop bends the spine within that stretch
// too.
constexpr double kUpperBack = 0.12;
constexpr double kBendWithin = 1.12;
double upright_back(double neck_girth) {
  return (3.5 + 190 * (neck_girth - 0.188)) * kDegree;
}

// By how much the upper trunk is bent forward, radians.
double stoop_of(const BodyShape& body, const Neck& neck) {
  const double s = body.stature;
  const Vector3d top = find_neck_back(body, neck), reach(0.12 * s, 0.01 * s, kUpperBack * s + 0.01);
  Vector3d back = top;
  const std::vector<int> skin = triangles_in_box(body, top - reach, top + reach);
  for (const geometry::SectionLoop& loop : cut(body, skin, top, Vector3d::UnitY()))
    for (const Vector3d& p : loop.points)
      if (p.z() < top.z() && std::abs((p - top).norm() - kUpperBack * s) < 0.005 &&
          (back == top || p.x() < back.x()))
        back = p;
  if (back == top) return neck.turn;
  return kBendWithin * (std::atan2(top.x() - back.x(), top.z() - back.z()) - upright_back(neck.girth / s));
}

// Height of the shoulder's top in the sagittal plane y, or a negative one where there is none.
double ridge_at(const BodyShape& body, const std::vector<int>& skin, double y) {
  double top = -1;
  for (const geometry::SectionLoop& loop : cut(body, skin, {0, y, 0}, Vector3d::UnitY()))
    for (const Vector3d& p : loop.points) top = std::max(top, p.z());
  return top;
}

// How far out from the neck's side the shoulder's line turns down into a hanging arm; negative where it does
// not within reach of a collarbone.
double turning_down(const BodyShape& body, const Vector3d& neck_side, Side side) {
  const double s = body.stature, sign = kSign[side];
  const double near = neck_side.y(), far = near + sign * 0.14 * s;
  const std::vector<int> skin =
      triangles_in_box(body, {neck_side.x() - 0.09 * s, std::min(near, far), neck_side.z() - 0.12 * s},
                       {neck_side.x() + 0.05 * s, std::max(near, far), neck_side.z() + 0.02 * s});
  std::vector<double> heights;
  for (double d = 0.02 * s; d < 0.13 * s; d += kApart)
    heights.push_back(ridge_at(body, skin, neck_side.y() + sign * d));
  double before = 1;
  bool flat = false;
  for (int i = kReach; i + kReach < static_cast<int>(heights.size()); ++i) {
    if (heights[i + kReach] < 0) break;
    const double slope = (heights[i - kReach] - heights[i + kReach]) / (2 * kReach * kApart);
    flat = flat || slope < kFlat || slope < before;
    if (flat && slope >= kSlopeAtAcromion && before < kSlopeAtAcromion)
      return 0.02 * s + (i - 1 + (kSlopeAtAcromion - before) / (slope - before)) * kApart;
    before = slope;
  }
  return -1;
}

// The skin of the sagittal plane through `place` that is nearest to it, on top of the shoulder.
bool skin_near(const BodyShape& body, const Vector3d& place, const Vector3d& up, Vector3d& point) {
  const double s = body.stature;
  const Vector3d reach = Vector3d(0.06, 0.03, 0.07) * s;
  double least = 1e9;
  const std::vector<int> skin = triangles_in_box(body, place - reach, place + reach);
  for (const geometry::SectionLoop& loop : cut(body, skin, place, Vector3d::UnitY())) {
    for (const Vector3d& p : loop.points) {
      const double off = (p - place).norm();
      if (off >= least || up.dot(p - place) < -0.03 * s) continue;
      least = off;
      point = p;
    }
  }
  return least < 1e8;
}

}  // namespace

Shoulder find_shoulder(const BodyShape& body, const Trunk& trunk, const Neck& neck, Side side) {
  const double s = body.stature, sign = kSign[side];
  const Axilla& axilla = trunk.axilla(side);
  Shoulder shoulder;
  if (!neck.found && !axilla.found) {
    shoulder.reason = "neither neck nor arm tells where it is";
    return shoulder;
  }
  Vector3d place, up = Vector3d::UnitZ();
  if (neck.found) {
    const Vector3d base = find_neck_side(body, neck, side);
    const bool hanging = axilla.found && !axilla.raised;
    double out = (hanging ? kFromNeckOut : kRaisedFromNeckOut) * s;
    if (hanging) {
      double beside = sign * (axilla.point.y() - base.y()) + kBeyondAxilla * s;
      const double turn = turning_down(body, base, side);
      if (turn > 0) beside = (beside + turn) / 2;
      out = kBoneTells * out + (1 - kBoneTells) * beside;
    }
    const double stoop = stoop_of(body, neck);
    up = {std::sin(stoop), 0, std::cos(stoop)};
    const Vector3d forwards(up.z(), 0, -up.x());
    place = base - kFromNeckBack * s * forwards - kFromNeckDown * s * up;
    place.y() = base.y() + sign * out;
  } else {
    const std::vector<Outline> chest = trunk.outline_at(axilla.point.z() - 0.02 * s);
    const double x = chest.empty() ? axilla.point.x() : chest.front().centroid.x();
    place = {x - 0.01 * s, axilla.point.y() + sign * kBeyondAxilla * s, axilla.point.z() + 0.055 * s};
    shoulder.confidence = 0.4;
    shoulder.reason = "no neck; judged by the axilla alone";
  }
  shoulder.found = skin_near(body, place, up, shoulder.point);
  if (!shoulder.found) shoulder.reason = "no skin over the end of the collarbone";
  return shoulder;
}

}  // namespace tensegric_fit::landmarks
