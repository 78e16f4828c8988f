#include <algorithm>
#include <cmath>

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
constexpr int kHalvings = 12;                            // of the search for the highest plane: 0.1 mm
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

/// Middle of the gap between arm and trunk in a plane; nothing where they are one.
std::optional<Vector3d> gap(const Surface& surface, Side side, double height, double rise) {
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
  Vector3d between = Vector3d::Zero();
  double nearest = 1e9;
  for (const Vector3d& a : arm->points)
    for (const Vector3d& b : trunk->points)
      if ((a - b).squaredNorm() < nearest) {
        nearest = (a - b).squaredNorm();
        between = (a + b) / 2;
      }
  return between;
}

}  // namespace

std::optional<Vector3d> find_axilla(const Surface& surface, Side side, double lowest, double highest,
                                    double rise) {
  std::optional<Vector3d> found = gap(surface, side, lowest, rise);
  if (!found) return std::nullopt;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (lowest + highest) / 2;
    if (const auto here = gap(surface, side, middle, rise)) {
      found = here;
      lowest = middle;
    } else {
      highest = middle;
    }
  }
  return found;
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
