#include "virtual_body/doubts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/points.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
constexpr double kLeastCrease = 12,
                 kWideFold = 0.016;         // 1/m, m: flatter or wider folds have no place of their own
constexpr double kSeenFold = 35 * kDegree;  // opening of a pocket that a sensor in front sees into
constexpr double kMuchGirth = 0.018;    // m of girth that a fold's level makes, from 11 mm below to 5 above
constexpr double kFlatMidline = 0.015;  // m
constexpr double kSeenGap = 0.004;      // m between thighs that a sensor sees through
constexpr double kHalfRaised = 30 * kDegree, kRaised = 60 * kDegree;
constexpr double kFleshyArm = 0.19;  // girth of an upper arm over stature
constexpr double kOffBone = 0.012;   // m from the acromion to where the shoulder's outline turns down
constexpr double kRidgeStep = 0.002, kRidgeWindow = 0.006, kRidgeSmoothing = 3;  // m, m, steps

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// The least way between the thighs 3 to 12 cm below the crotch; negative where they are one.
double gap_between_thighs(const Skin& skin, const Vector3d& crotch) {
  double least = std::numeric_limits<double>::infinity();
  for (const double below : {0.03, 0.06, 0.09, 0.12}) {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (const auto& loop : skin.cut({0, 0, crotch.z() - below}, Vector3d::UnitZ(), Part::trunk)) {
      const auto box = geometry::bounding_box(loop.points);
      if (geometry::mean_of(loop.points).y() > crotch.y())
        left = std::min(left, box[0].y());
      else
        right = std::max(right, box[1].y());
    }
    least = std::min(least, std::isfinite(left) && std::isfinite(right) ? left - right : -1.0);
  }
  return least;
}

/// How far to the side the top of the shoulder, cut across, first falls by 45 degrees; nothing where it does
/// not.
std::optional<double> ridge_turn(const Skin& skin, const Vector3d& shoulder, Side side) {
  std::vector<double> out, top;
  const auto lines = skin.cut(shoulder, Vector3d::UnitX(), Part::whole);
  const double start = kSign[side] * shoulder.y() - 0.06, end = kSign[side] * shoulder.y() + 0.08;
  for (double y = start; y < end; y += kRidgeStep) {
    double highest = -1;
    for (const auto& line : lines)
      for (const Vector3d& p : line.points)
        if (std::abs(kSign[side] * p.y() - y) < kRidgeWindow) highest = std::max(highest, p.z());
    if (highest < 0) continue;
    out.push_back(y);
    top.push_back(highest);
  }
  const int count = static_cast<int>(out.size()), reach = static_cast<int>(4 * kRidgeSmoothing);
  if (count < 10) return std::nullopt;
  const auto smooth = [&](int i) {
    double sum = 0, weight = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double w = std::exp(-0.5 * k * k / (kRidgeSmoothing * kRidgeSmoothing));
      sum += w * top[std::clamp(i + k, 0, count - 1)];
      weight += w;
    }
    return sum / weight;
  };
  for (int i = 1; i + 1 < count; ++i)
    if ((smooth(i - 1) - smooth(i + 1)) / (out[i + 1] - out[i - 1]) > 1) return out[i];
  return std::nullopt;
}

bool is_shoulder_vague(const Skin& skin, double raised, Side side, const VirtualBody& body) {
  if (raised > kRaised) return true;
  if (raised > kHalfRaised) {  // a raised arm lifts the outline: only flesh counts
    for (const geometry::Measure& girth : body.truth.girths)
      if (girth.name == std::string("upper_arm") + kSuffix[side])
        return girth.metres > kFleshyArm * body.truth.height("stature");
    return false;
  }
  const Vector3d& shoulder = body.truth.landmark(std::string("shoulder") + kSuffix[side]);
  const auto turn = ridge_turn(skin, shoulder, side);
  return !turn || std::abs(*turn - kSign[side] * shoulder.y()) > kOffBone;
}

}  // namespace

void doubt_folds(const Skin& skin, VirtualBody& body) {
  bool vague = false;
  double narrowest = M_PI;
  for (const Side side : kSides) {
    const auto fold = find_fold(skin, body.truth.landmark(std::string("bust_point") + kSuffix[side]), side);
    vague |= !fold || fold->curvature < kLeastCrease || fold->width > kWideFold || fold->rival;
    if (fold) narrowest = std::min(narrowest, fold->opening);
  }
  const double fold = body.truth.height("underbust");
  if (vague) body.doubts.vague.push_back("height underbust");
  if (vague &&
      std::abs(girth(skin.round_torso(fold - 0.011)) - girth(skin.round_torso(fold + 0.005))) > kMuchGirth)
    add_once(body.doubts.vague, "girth underbust");
  if (narrowest < kSeenFold)
    for (const char* name : {"girth underbust", "height underbust"}) add_once(body.doubts.hidden, name);
}

void doubt_crotch(const Skin& skin, VirtualBody& body) {
  const Vector3d& point = body.truth.landmark("crotch");
  if (find_crotch(skin, point).flat > kFlatMidline)
    body.doubts.loose.emplace_back("crotch", Vector3d::UnitX());
  if (gap_between_thighs(skin, point) < kSeenGap)
    for (const char* name : {"height crotch", "point crotch"}) add_once(body.doubts.hidden, name);
}

void doubt_shoulder(const Skin& skin, const Ray& upper_arm, Side side, VirtualBody& body) {
  const double raised = std::atan2(kSign[side] * upper_arm.direction.y(), -upper_arm.direction.z());
  if (is_shoulder_vague(skin, raised, side, body))
    body.doubts.vague.push_back(std::string("point shoulder") + kSuffix[side]);
  if (raised >= kRaised) body.doubts.vague.push_back(std::string("point axilla") + kSuffix[side]);
  body.doubts.loose.emplace_back(std::string("axilla") + kSuffix[side], Vector3d::UnitX());
}

}  // namespace tensegric_fit::virtual_body
