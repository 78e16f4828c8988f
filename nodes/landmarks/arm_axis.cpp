#include "landmarks/arm_axis.hpp"

#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// Statures.
constexpr double kUpper = 0.03, kLower = 0.07;  // below the axilla: sections whose middles tell the arm's way
constexpr double kFurtherDown = 0.02;  // both, where skin that fills the armpit joins the arm to the trunk
constexpr double kArmRadius = 0.06;
constexpr double kStart = 0.06, kHalfArm = 0.03;  // from the axilla to the middle of an arm: along, across
constexpr int kPasses = 4;

// The outline at a height whose middle is nearest to `place`, no further than `widest`.
const Outline* outline_near(const std::vector<Outline>& outlines, const Eigen::Vector2d& place,
                            double widest) {
  const Outline* best = nullptr;
  for (const Outline& outline : outlines) {
    if ((outline.centroid - place).norm() >= widest) continue;
    widest = (outline.centroid - place).norm();
    best = &outline;
  }
  return best;
}

}  // namespace

bool loop_round(const BodyShape& body, const Vector3d& origin, const Vector3d& axis, double radius,
                std::vector<Vector3d>& points, Vector3d& middle) {
  const Vector3d reach = Vector3d::Constant(1.5 * radius);
  double nearest = radius;
  bool found = false;
  for (const geometry::SectionLoop& loop :
       cut(body, triangles_in_box(body, origin - reach, origin + reach), origin, axis)) {
    if (!loop.closed || loop.points.size() < 10) continue;
    const auto [low, high] = geometry::bounding_box(loop.points);
    const Vector3d here = (low + high) / 2;
    if ((here - origin).norm() >= nearest) continue;
    nearest = (here - origin).norm();
    middle = here;
    points = loop.points;
    found = true;
  }
  return found;
}

ArmAxis find_arm_axis(const BodyShape& body, const ArmSearch& search, Side side) {
  const double s = body.stature, radius = kArmRadius * s, sign = kSign[side];
  ArmAxis arm;
  arm.direction = Vector3d(0, sign * std::sin(search.abduction), -std::cos(search.abduction));
  const Vector3d outwards(0, sign * std::cos(search.abduction), std::sin(search.abduction));
  arm.point = search.axilla + kStart * s * arm.direction + kHalfArm * s * outwards;
  if (!search.raised) {
    const double below = search.axilla.z() - kStart * s;
    const std::vector<Outline> outlines = body.sliced.outlines_at(below);
    const Outline* section = outline_near(outlines, arm.point.head<2>(), 0.07 * s);
    if (section != nullptr) arm.point = {section->centroid.x(), section->centroid.y(), below};
  }
  std::vector<Vector3d> points;
  for (int pass = 0; pass < kPasses; ++pass) {
    Vector3d upper, lower;
    const auto middle_at = [&](double along, Vector3d& middle) {
      const double there = arm.direction.dot(search.axilla - arm.point) + along * s;
      return loop_round(body, arm.point + there * arm.direction, arm.direction, radius, points, middle);
    };
    const auto look = [&](double further) {
      return middle_at(kUpper + further, upper) && middle_at(kLower + further, lower);
    };
    arm.found = look(0) || look(kFurtherDown);
    if (!arm.found) return arm;
    arm.direction = (lower - upper).normalized();
    arm.point = upper;
  }
  return arm;
}

}  // namespace tensegric_fit::landmarks
