#include "landmarks/limb_girths.hpp"

#include <algorithm>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// Statures.
constexpr double kBelowAxilla = 0.051, kBelowCrotch = 0.039, kUnderTouchingThighs = 0.012;
constexpr double kUpper = 0.03, kLower = 0.09;  // below the axilla: sections whose middles tell the arm's way
constexpr double kFurtherDown = 0.02;  // both, where skin that fills the armpit joins the arm to the trunk
constexpr double kLowerThigh = 0.10;   // below the thigh's girth: the same of the thigh
constexpr double kArmRadius = 0.06, kThighRadius = 0.10, kBothThighs = 0.25, kBetweenThighs = 0.015;

// The loop of material in the plane that runs round `origin` most nearly, and its middle; false where none
// closes.
bool loop_round(const BodyShape& body, const Vector3d& origin, const Vector3d& axis, double radius,
                std::vector<Vector3d>& points, Vector3d& middle) {
  const Vector3d reach = Vector3d::Constant(1.5 * radius);
  double nearest = radius;
  bool found = false;
  for (const geometry::SectionLoop& loop :
       cut(body, triangles_in_box(body, origin - reach, origin + reach), origin, axis)) {
    if (!loop.closed || loop.points.size() < 10) continue;
    Vector3d low = loop.points.front(), high = low;
    for (const Vector3d& p : loop.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double off = ((low + high) / 2 - origin).norm();
    if (off >= nearest) continue;
    nearest = off;
    middle = (low + high) / 2;
    points = loop.points;
    found = true;
  }
  return found;
}

// The outline at a height whose middle is nearest to `place`, on that side of the body's middle.
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

// One side's half of the largest loop in the plane: of two thighs that touch, this one. They part where they
// are narrowest.
std::vector<Vector3d> half_loop(const BodyShape& body, const Vector3d& origin, const Vector3d& axis,
                                Side side) {
  const double near = kBetweenThighs * body.stature, middle = body.crotch.above.y;
  const double between =
      narrowest_bridge(body.sliced.outlines_at(origin.z()), middle - near, middle + near).y;
  const Vector3d reach = Vector3d::Constant(kBothThighs * body.stature);
  std::vector<Vector3d> both;
  for (const geometry::SectionLoop& loop :
       cut(body, triangles_in_box(body, origin - reach, origin + reach), origin, axis))
    if (loop.closed && loop.points.size() > both.size()) both = loop.points;
  both.erase(std::remove_if(both.begin(), both.end(),
                            [&](const Vector3d& p) { return kSign[side] * (p.y() - between) < 0; }),
             both.end());
  return both;
}

}  // namespace

LimbGirth find_upper_arm_girth(const BodyShape& body, const Trunk& trunk, const Vector3d& shoulder,
                               Side side) {
  const double s = body.stature, radius = kArmRadius * s;
  const Axilla& axilla = trunk.axilla(side);
  LimbGirth girth;
  // From the middle of the arm's root, out for a raised arm and down to its section for one that hangs; then
  // square to the way from one section's middle to the next.
  const Vector3d root = (shoulder + axilla.point) / 2;
  Vector3d axis = Vector3d(0, kSign[side], -0.3).normalized();
  const std::vector<Outline> below = body.sliced.outlines_at(axilla.point.z() - kBelowAxilla * s);
  const Outline* arm = nullptr;
  if (!axilla.raised) arm = outline_near(below, {root.x(), root.y() + kSign[side] * 0.02 * s}, 0.07 * s);
  if (arm != nullptr)
    axis = (Vector3d(arm->centroid.x(), arm->centroid.y(), axilla.point.z() - kBelowAxilla * s) - root)
               .normalized();
  std::vector<Vector3d> points;
  Vector3d on_axis = root;
  for (int pass = 0; pass < 4; ++pass) {
    Vector3d upper, lower;
    const auto place = [&](double along) -> Vector3d {
      return on_axis + (axis.dot(axilla.point - on_axis) + along * s) * axis;
    };
    const auto look = [&](double further) {
      return loop_round(body, place(kUpper + further), axis, radius, points, upper) &&
             loop_round(body, place(kLower + further), axis, radius, points, lower);
    };
    if (!look(0) && !look(kFurtherDown)) {
      girth.reason = "no arm that stands clear of the trunk below the axilla";
      return girth;
    }
    axis = (lower - upper).normalized();
    on_axis = upper;
  }
  Vector3d middle;
  const Vector3d origin = on_axis + (axis.dot(axilla.point - on_axis) + kBelowAxilla * s) * axis;
  if (loop_round(body, origin, axis, radius, points, middle)) girth.tape = geometry::tape(points, axis);
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
    const Vector3d level_across = Vector3d(axis.x(), 0, axis.z()).normalized();
    points = half_loop(body, upper + (wanted - upper.z()) / axis.z() * axis, level_across, side);
    if (points.size() >= 10) girth.tape = geometry::tape(points, level_across);
    girth.confidence = 0.45;
    girth.reason = "the thighs touch; half of what is round both";
  } else if (loop_round(body, upper, axis, kThighRadius * s, points, middle)) {
    girth.tape = geometry::tape(points, axis);
  }
  if (girth.tape.empty()) girth.reason = "no closed section round the thigh";
  return girth;
}

}  // namespace tensegric_fit::landmarks
