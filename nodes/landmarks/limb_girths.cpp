#include "landmarks/limb_girths.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "landmarks/arm_axis.hpp"
#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// Statures.
constexpr double kBelowAxilla = 0.051, kBelowCrotch = 0.039, kUnderTouchingThighs = 0.012;
constexpr double kLowerThigh = 0.10;  // below the thigh's girth: the same of the thigh
constexpr double kArmRadius = 0.06, kThighRadius = 0.10, kBothThighs = 0.25, kBetweenThighs = 0.015;
constexpr double kHandBeside = 0.06;  // a hand stays farther than this from the parting
constexpr double kGroove = 0.0095;    // 16 mm

// Of the box round them.
Vector3d middle_of(const std::vector<Vector3d>& points) {
  const auto [low, high] = geometry::bounding_box(points);
  return (low + high) / 2;
}

// One side's half of what a plane cuts: of two thighs that touch, this one.
struct Half {
  std::vector<Vector3d> points;
  double parting;  // y of the plane between the two, where they are narrowest
};

Half half_section(const BodyShape& body, const Vector3d& origin, const Vector3d& axis, Side side) {
  const double near = kBetweenThighs * body.stature, middle = body.crotch.above.y;
  const double between =
      narrowest_bridge(body.sliced.outlines_at(origin.z()), middle - near, middle + near).y;
  const Vector3d reach = Vector3d::Constant(kBothThighs * body.stature);
  Half half{{}, between};
  for (const geometry::SectionLoop& loop :
       cut(body, triangles_in_box(body, origin - reach, origin + reach), origin, axis)) {
    if (!loop.closed || (middle_of(loop.points) - origin).norm() > kBothThighs / 2 * body.stature) continue;
    const bool is_hand = std::all_of(loop.points.begin(), loop.points.end(), [&](const Vector3d& p) {
      return std::abs(p.y() - between) > kHandBeside * body.stature;
    });
    if (is_hand) continue;
    std::copy_if(loop.points.begin(), loop.points.end(), std::back_inserter(half.points),
                 [&](const Vector3d& p) { return kSign[side] * (p.y() - between) >= 0; });
  }
  return half;
}

// The half without the corners that skin over the grooves before and behind the parting makes of it: the
// thigh's own are as far as `groove` round.
std::vector<Vector3d> rounded(const Half& half, double groove) {
  std::vector<Vector3d> points;
  const Vector3d *front = nullptr, *back = nullptr;  // of what lies along the parting
  for (const Vector3d& p : half.points) {
    const double off = std::abs(p.y() - half.parting);
    if (off >= groove) points.push_back(p);
    if (off > groove / 4) continue;
    if (front == nullptr || p.x() > front->x()) front = &p;
    if (back == nullptr || p.x() < back->x()) back = &p;
  }
  if (front == nullptr || (*front - *back).norm() < 2 * groove) return half.points;
  const Vector3d inwards = groove * (*front - *back).normalized();
  for (Vector3d p : {Vector3d(*front - inwards), Vector3d(*back + inwards)}) {
    p.y() = half.parting;
    points.push_back(p);
  }
  return points;
}

// The tape round one of two thighs that touch; empty where there is no skin. `place` lies in the leg below.
std::vector<Vector3d> tape_of_half(const BodyShape& body, Vector3d place, double height, Side side) {
  Vector3d middles[2];
  for (const int below : {1, 0}) {
    place.z() = height - below * kLowerThigh * body.stature;
    const Half half = half_section(body, place, Vector3d::UnitZ(), side);
    if (half.points.size() < 3) return {};
    middles[below] = place = middle_of(half.points);
  }
  // The halves' middles are not the thighs': across, the tape lies level.
  const Vector3d way = middles[0] - middles[1], axis = Vector3d(way.x(), 0, way.z()).normalized();
  return geometry::tape(rounded(half_section(body, place, axis, side), kGroove * body.stature), axis);
}

}  // namespace

LimbGirth find_upper_arm_girth(const BodyShape& body, const Axilla& axilla, Side side) {
  const double s = body.stature;
  LimbGirth girth;
  const ArmAxis arm = find_arm_axis(body, {axilla.point, axilla.abduction, axilla.raised}, side);
  if (!arm.found) {
    girth.reason = "no arm that stands clear of the trunk below the axilla";
    return girth;
  }
  std::vector<Vector3d> points;
  Vector3d middle;
  const double along = arm.direction.dot(axilla.point - arm.point) + kBelowAxilla * s;
  if (loop_round(body, arm.point + along * arm.direction, arm.direction, kArmRadius * s, points, middle))
    girth.tape = geometry::tape(points, arm.direction);
  if (girth.tape.empty()) girth.reason = "no closed section round the upper arm";
  if (axilla.filled) {
    girth.confidence = 0.45;
    girth.reason = "the axilla that it is measured from lies in filled skin";
  }
  return girth;
}

LimbGirth find_thigh_girth(const BodyShape& body, Side side) {
  const double s = body.stature, wanted = body.crotch.height - kBelowCrotch * s;
  const double height = std::min(wanted, body.levels.legs_part - kUnderTouchingThighs * s);
  LimbGirth girth;
  const auto leg_at = [&](double z, Vector3d& middle) {
    const Level& level = body.levels.levels[body.levels.nearest(z)];
    for (const int k : level.legs) {
      if (k < 0 || kSign[side] * (level.outlines[k].centroid.y() - body.crotch.above.y) < 0) continue;
      middle = {level.outlines[k].centroid.x(), level.outlines[k].centroid.y(), level.height};
      return true;
    }
    return false;
  };
  Vector3d upper, lower, middle;
  std::vector<Vector3d> points;
  if (!leg_at(height, upper) || !leg_at(height - kLowerThigh * s, lower)) {
    girth.reason = "no leg that stands clear of the other";
    return girth;
  }
  const Vector3d axis = (upper - lower).normalized();
  if (height < wanted) {
    girth.tape = tape_of_half(body, upper, wanted, side);
    girth.confidence = 0.45;
    girth.reason = "the thighs touch; half of what is round both";
  } else if (loop_round(body, upper, axis, kThighRadius * s, points, middle)) {
    girth.tape = geometry::tape(points, axis);
  }
  if (girth.tape.empty()) girth.reason = "no closed section round the thigh";
  return girth;
}

}  // namespace tensegric_fit::landmarks
