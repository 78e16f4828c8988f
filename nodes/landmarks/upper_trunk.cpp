#include <algorithm>
#include <cmath>

#include "geometry/points.hpp"
#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;
using geometry::mean_of;
using geometry::SectionLoop;

constexpr double kArmBeside = 0.08;                      // m from the trunk's middle to an arm's, at least
constexpr int kHalvings = 12;                            // of the search for the highest plane: 0.1 mm
constexpr int kHarmonics = 8, kLoopPoints = 180;         // of a neck: waves of 40 mm
constexpr double kNeckStep = 0.005, kNeckReach = 0.040;  // m (definition)

/// Whether a loop goes round the body, and not round a hollow within: a fold that the scan did not see into
/// may go on inside the mesh.
bool is_outline(const SectionLoop& loop, const Vector3d& normal) {
  Vector3d twice_area = Vector3d::Zero();
  const Vector3d& first = loop.points.front();
  for (std::size_t i = 1; i + 1 < loop.points.size(); ++i)
    twice_area += geometry::area_vector(first, loop.points[i], loop.points[i + 1]);
  return loop.closed && twice_area.dot(normal) > 0;
}

/// Middle of the gap between arm and trunk in a plane; nothing where they are one.
std::optional<Vector3d> gap(const Surface& surface, Side side, double height, double rise) {
  const double tilt = kSign[side] * rise;
  const Vector3d normal(0, -std::sin(tilt), std::cos(tilt)), origin(0, kSign[side] * 0.15, height);
  const auto loops = cut(surface, origin, normal, [](const Eigen::Vector3i&) { return true; });
  const SectionLoop *trunk = nullptr, *arm = nullptr;
  double widest = 0;
  for (const SectionLoop& loop : loops) {
    if (!is_outline(loop, normal)) continue;
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
    if (!is_outline(loop, normal) || &loop == trunk ||
        kSign[side] * (mean_of(loop.points).y() - middle) < kArmBeside)
      continue;
    if (arm == nullptr || loop.points.size() > arm->points.size()) arm = &loop;
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

/// A closed loop by its first harmonics over its length (elliptic Fourier descriptors; Kuhl and Giardina
/// 1982): a tape round the loop itself would lie on its noise, by some 6 times what a small loop's skin is
/// rough.
std::vector<Vector3d> without_noise(std::vector<Vector3d> loop) {
  loop.push_back(loop.front());
  const double whole = geometry::length_of(loop, false);
  loop = even_steps(loop, whole / kLoopPoints, whole);
  const int count = static_cast<int>(loop.size());
  const Vector3d middle = mean_of(loop);
  std::vector<Vector3d> smooth(count, middle);
  for (int h = 1; h <= kHarmonics; ++h) {
    Vector3d even = Vector3d::Zero(), odd = Vector3d::Zero();
    for (int i = 0; i < count; ++i) {
      even += std::cos(2 * M_PI * h * i / count) * (loop[i] - middle) * 2 / count;
      odd += std::sin(2 * M_PI * h * i / count) * (loop[i] - middle) * 2 / count;
    }
    for (int i = 0; i < count; ++i)
      smooth[i] += std::cos(2 * M_PI * h * i / count) * even + std::sin(2 * M_PI * h * i / count) * odd;
  }
  return smooth;
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
  std::optional<double> highest;
  for (const Eigen::Vector3i& t : surface.mesh.triangles) {
    const Vector3d &a = surface.mesh.vertices[t[0]], &b = surface.mesh.vertices[t[1]],
                   &c = surface.mesh.vertices[t[2]];
    const double det = (b - a).head<2>().x() * (c - a).y() - (c - a).x() * (b - a).y();
    if (std::abs(det) < 1e-15) continue;
    const Vector3d d = point - a;
    const double u = (d.x() * (c - a).y() - (c - a).x() * d.y()) / det,
                 v = ((b - a).x() * d.y() - d.x() * (b - a).y()) / det;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
    const double z = a.z() + u * (b - a).z() + v * (c - a).z();
    if (z > point.z() - 0.04 && z < point.z() + 0.11 && (!highest || z > *highest)) highest = z;
  }
  if (!highest) return std::nullopt;
  return Vector3d(point.x(), point.y(), *highest);
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
    std::vector<Vector3d> tape = geometry::tape(without_noise(around->points), along);
    const double girth = geometry::length_of(tape, true);
    if (girth >= least || girth < 0.2) continue;
    least = girth;
    best = std::move(tape);
  }
  return best;
}

}  // namespace tensegric_fit::landmarks
