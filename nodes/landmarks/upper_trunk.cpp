#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/even_steps.hpp"
#include "geometry/points.hpp"
#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

using geometry::mean_of;
using geometry::SectionLoop;

constexpr double kArmBeside =
    0.08;  // m from the trunk's middle to an arm's; what is nearer lies within it (tolerance)
constexpr double kUnderShoulder = 0.04,
                 kOverShoulder = 0.11;  // m, flesh over the acromion (definition: README.md, shoulder)
// Mean share of an arm in an outline: arms of 24 training and 20 implicit surfaces have 0.77 and more, other
// things none; any limit between does.
constexpr double kLeastArm = 0.25;
constexpr double kNearlyTouch =
    0.002;                     // m: skins nearly touch up to this much beyond the narrowest gap (definition)
constexpr int kHalvings = 12;  // of the search for the highest plane: 0.1 mm
constexpr int kHarmonics = 8, kLoopPoints = 180;         // of a neck: waves of 40 mm
constexpr double kNeckStep = 0.005, kNeckReach = 0.040;  // m (definition: README.md, neck)

/// How much of an outline an arm carries, 0 to 1.
double arm_share(const Surface& surface, const SectionLoop& loop) {
  double sum = 0;
  for (const int triangle : loop.triangles) {
    const Eigen::Vector3i& t = surface.mesh.triangles[triangle];
    sum += (surface.arm[t[0]] + surface.arm[t[1]] + surface.arm[t[2]]) / 3;
  }
  return sum / static_cast<double>(loop.triangles.size());
}

/// Outlines in a plane.
struct ArmAndTrunk {
  SectionLoop arm, trunk;
};

/// Nothing where they are one.
std::optional<ArmAndTrunk> parted(const Surface& surface, Side side, double height, double rise) {
  const double tilt = kSign[side] * rise;
  const Vector3d normal(0, -std::sin(tilt), std::cos(tilt)), origin(0, kSign[side] * 0.15, height);
  const auto loops = cut(surface, origin, normal, [](const Eigen::Vector3i&) { return true; });
  const SectionLoop *trunk = nullptr, *arm = nullptr;
  double widest = 0;
  for (const SectionLoop& loop : loops) {
    if (!geometry::is_outline(loop, normal)) continue;
    const auto box = geometry::bounding_box(loop.points);
    const bool middle = box[0].y() < 0.05 && box[1].y() > -0.05;
    const double width = box[1].y() - box[0].y() + (middle ? 10 : 0);
    if (width <= widest) continue;
    widest = width;
    trunk = &loop;
  }
  if (trunk == nullptr) return std::nullopt;
  const double middle = mean_of(trunk->points).y();
  for (const SectionLoop& loop : loops) {
    if (!geometry::is_outline(loop, normal) || &loop == trunk ||
        kSign[side] * (mean_of(loop.points).y() - middle) < kArmBeside)
      continue;
    if (arm_share(surface, loop) >= kLeastArm &&
        (arm == nullptr || geometry::length_of(loop.points, true) > geometry::length_of(arm->points, true)))
      arm = &loop;
  }
  if (arm == nullptr) return std::nullopt;
  return ArmAndTrunk{*arm, *trunk};
}

Vector3d nearest_on(const SectionLoop& loop, const Vector3d& point) {
  Vector3d nearest = loop.points.front();
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const Vector3d &from = loop.points[i], way = loop.points[(i + 1) % loop.points.size()] - from;
    const double length = way.squaredNorm();
    const Vector3d here =
        from + (length > 0 ? std::clamp((point - from).dot(way) / length, 0.0, 1.0) : 0) * way;
    if ((here - point).squaredNorm() < (nearest - point).squaredNorm()) nearest = here;
  }
  return nearest;
}

/// Middle of where the two are nearest. Skins that nearly touch along some centimetres are so all along them.
Vector3d middle_of_gap(const ArmAndTrunk& outlines) {
  const std::vector<Vector3d>& arm = outlines.arm.points;
  std::vector<Vector3d> across;  // from the arm to the trunk
  double narrowest = 1e9;
  for (const Vector3d& p : arm) {
    across.push_back(nearest_on(outlines.trunk, p) - p);
    narrowest = std::min(narrowest, across.back().norm());
  }
  Vector3d sum = Vector3d::Zero();
  double weights = 0;
  for (std::size_t i = 0; i < arm.size(); ++i) {
    const double length = ((arm[i] - arm[(i + 1) % arm.size()]).norm() +
                           (arm[i] - arm[(i + arm.size() - 1) % arm.size()]).norm()) /
                          2;
    const double weight = length * std::max(0.0, 1 - (across[i].norm() - narrowest) / kNearlyTouch);
    sum += weight * (arm[i] + across[i] / 2);
    weights += weight;
  }
  return weights > 0 ? Vector3d(sum / weights) : arm.front();  // all of it in one point
}

}  // namespace

std::optional<Vector3d> find_axilla(const Surface& surface, Side side, double lowest, double highest,
                                    double rise) {
  std::optional<ArmAndTrunk> found = parted(surface, side, lowest, rise);
  if (!found) return std::nullopt;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (lowest + highest) / 2;
    if (auto here = parted(surface, side, middle, rise)) {
      found = std::move(here);
      lowest = middle;
    } else {
      highest = middle;
    }
  }
  return middle_of_gap(*found);
}

std::optional<Vector3d> skin_above(const Surface& surface, const Vector3d& point) {
  return geometry::highest_near(surface.mesh, point, kUnderShoulder, kOverShoulder);
}

std::vector<Vector3d> find_neck(const Surface& surface, const Vector3d& base, const Vector3d& along) {
  std::vector<Vector3d> best;
  double least = 1e9;
  for (double up = 0; up < kNeckReach + kNeckStep / 2; up += kNeckStep) {
    const Vector3d origin = base + up * along;
    const SectionLoop* around = nullptr;
    const auto loops = cut(surface, origin, along, [](const Eigen::Vector3i&) { return true; });
    for (const SectionLoop& loop : loops)
      if (loop.closed && (around == nullptr ||
                          (mean_of(loop.points) - origin).norm() < (mean_of(around->points) - origin).norm()))
        around = &loop;
    if (around == nullptr) continue;
    std::vector<Vector3d> tape =
        geometry::tape(geometry::first_harmonics(around->points, kHarmonics, kLoopPoints), along);
    const double girth = geometry::length_of(tape, true);
    if (girth >= least || girth < 0.2) continue;
    least = girth;
    best = std::move(tape);
  }
  return best;
}

}  // namespace tensegric_fit::landmarks
