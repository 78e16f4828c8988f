#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "geometry/parabola.hpp"
#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

constexpr double kLevels = 0.0025,
                 kSmoothing = 2;    // m between tapes; levels: deviation of the Gaussian over their girths
constexpr int kEnd = 3;             // levels; a least girth this near the end of the search is the end's
constexpr double kBottom = 0.0176;  // m each way, of the parabola through the least girth
constexpr double kMoved = 0.006;    // m that it may move the level
constexpr double kSeatReach = 0.040,
                 kNarrowSeat =
                     0.025;        // m of a buttock's profile up and down; where that is round enough, less
constexpr double kLeastRound = 2;  // 1/m; flatter profiles have no apex
constexpr double kBeside = 0.010, kProfile = 0.12;        // m to the sides; of a profile's length
constexpr int kProfiles = 4;                              // on each side of the middle one
constexpr double kFlatSide = 0.003;                       // m: skin within it is as far to the side
constexpr double kPerineumReach = 0.04, kMidline = 0.06;  // m round it, and along the midline

/// Where a quadratic surface through the skin of a buttock is rearmost; `start` where it is so nowhere near.
Vector3d rearmost_near(const Surface& surface, const Vector3d& start) {
  Vector3d place = start;
  for (int pass = 0; pass < 8; ++pass) {
    const std::vector<int> near =
        vertices_near(surface, place, kSeatReach, [&](int v) { return surface.arm[v] < 0.5; });
    if (near.size() < 12) return start;  // twice the unknowns
    Eigen::MatrixXd terms(near.size(), 6);
    Eigen::VectorXd depth(near.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Vector3d d = (surface.mesh.vertices[near[i]] - place) / kSeatReach;
      terms.row(static_cast<int>(i)) << 1, d.y(), d.z(), d.y() * d.y(), d.y() * d.z(), d.z() * d.z();
      depth[static_cast<int>(i)] = d.x();
    }
    const Eigen::VectorXd c = terms.colPivHouseholderQr().solve(depth);
    Eigen::Matrix2d curvature;
    curvature << 2 * c[3], c[4], c[4], 2 * c[5];
    if (curvature.determinant() <= 0 || curvature.trace() <= 0) return start;
    Eigen::Vector2d step = -curvature.inverse() * Eigen::Vector2d(c[1], c[2]);
    if (step.norm() > 0.5) step *= 0.5 / step.norm();
    place += kSeatReach * Vector3d(c[0], step.x(), step.y());
    if ((place - start).norm() > kSeatReach) return start;
    if (step.norm() < 0.01) break;
  }
  return place;
}

}  // namespace

std::optional<Vector3d> find_buttock(const Trunk& trunk, const Vector3d& start_at) {
  const Vector3d expected = rearmost_near(trunk.surface(), start_at);
  // Profiles side by side: of each the parabola's apex, and the median of them.
  std::vector<Vector3d> apexes;
  for (int i = -kProfiles; i <= kProfiles; ++i) {
    const Vector3d start = expected + kBeside * i / kProfiles * Vector3d::UnitY();
    Profile profile = profile_down(trunk, start + kSeatReach * Vector3d::UnitZ(), kProfile);
    for (const double reach : {kNarrowSeat, kSeatReach}) {
      geometry::Parabola parabola;
      for (const Vector3d& p : profile.points) {
        const Vector3d d = (p - start) / kSeatReach;
        if (std::abs(p.z() - start.z()) <= reach && d.x() <= 1) parabola.add(d.z(), d.x());
      }
      if (parabola.count() < kNarrowSeat / Profile::kStep) continue;  // half of the profile's points
      const Vector3d c = parabola.coefficients();
      if (c[2] < kLeastRound * kSeatReach / 2) continue;  // flat: the wider reach may show it
      const double up = std::clamp(-c[1] / (2 * c[2]), -0.5, 0.5);
      apexes.emplace_back(start + kSeatReach * Vector3d(c[0] + up * (c[1] + up * c[2]), 0, up));
      break;
    }
  }
  if (apexes.empty()) return std::nullopt;
  std::sort(apexes.begin(), apexes.end(), [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
  const Vector3d& middle = apexes[apexes.size() / 2];
  return Vector3d(middle.x(), expected.y(), middle.z());  // which profile it was says nothing of the side
}

std::optional<Vector3d> find_gluteal_fold(const Trunk& trunk, const Vector3d& buttock, double length,
                                          double depth) {
  const Profile profile = profile_down(trunk, buttock, 2 * length);
  const auto end = std::find_if(profile.points.begin(), profile.points.end(),
                                [&](const Vector3d& p) { return p.z() < buttock.z() - length; });
  if (end == profile.points.end()) return std::nullopt;
  const Vector3d edge = (*end - buttock).normalized(), inwards = edge.cross(Vector3d::UnitY());
  std::optional<Vector3d> deepest;
  for (auto p = profile.points.begin(); p != end; ++p) {
    const double here = inwards.dot(*p - buttock);
    if (here <= depth) continue;
    depth = here;
    deepest = *p;
  }
  return deepest;
}

std::optional<Vector3d> skin_under(const Trunk& trunk, const Vector3d& start, double down) {
  const Profile profile = profile_down(trunk, start, 2 * down);
  const auto there = std::find_if(profile.points.begin(), profile.points.end(),
                                  [&](const Vector3d& p) { return p.z() < start.z() - down; });
  return there == profile.points.end() ? std::nullopt : std::optional<Vector3d>(*there);
}

std::optional<Vector3d> find_side(const Trunk& trunk, Side side, double height) {
  const std::vector<geometry::SectionLoop> loops = trunk.level(height);
  const Vector3d* farthest = nullptr;
  for (const geometry::SectionLoop& loop : loops)
    for (const Vector3d& p : loop.points)
      if (farthest == nullptr || kSign[side] * p.y() > kSign[side] * farthest->y()) farthest = &p;
  if (farthest == nullptr) return std::nullopt;
  // Where a side is flat one vertex or another is farthest: the middle of that skin, where it ends by
  // degrees.
  double sum = 0, weights = 0;
  for (const geometry::SectionLoop& loop : loops)
    for (std::size_t i = loop.closed ? 0 : 1; i < loop.points.size(); ++i) {
      Vector3d from = loop.points[(i + loop.points.size() - 1) % loop.points.size()], to = loop.points[i];
      const auto weight = [&](const Vector3d& p) {
        return 1 - kSign[side] * (farthest->y() - p.y()) / kFlatSide;
      };
      if (weight(from) < weight(to)) std::swap(from, to);
      const double outer = weight(from), inner = weight(to);
      if (outer <= 0) continue;
      if (inner < 0) to = from + outer / (outer - inner) * (to - from);  // the part that counts
      const double end = std::max(inner, 0.0), length = (to - from).norm();
      // of what changes evenly along it
      weights += length * (outer + end) / 2;
      sum += length * ((2 * outer + end) * from.x() + (outer + 2 * end) * to.x()) / 6;
    }
  return weights > 0 ? Vector3d(sum / weights, farthest->y(), farthest->z())
                     : *farthest;  // of a single point
}

std::vector<Vector3d> round_limb(const Surface& surface, const Vector3d& origin, const Vector3d& along,
                                 double reach, const Selected& selected) {
  std::vector<Vector3d> points;
  for (const geometry::SectionLoop& loop : cut(surface, origin, along, selected))
    std::copy_if(loop.points.begin(), loop.points.end(), std::back_inserter(points),
                 [&](const Vector3d& p) { return (p - origin).norm() < reach; });
  return points.size() < 3 ? std::vector<Vector3d>() : geometry::tape(points, along);
}

std::optional<double> find_waist(const Trunk& trunk, double lowest, double highest) {
  std::vector<double> heights, raw;
  for (double z = lowest; z <= highest + 1e-9; z += kLevels) {
    const std::vector<Vector3d> tape = trunk.tape_of_torso(z);
    if (tape.size() < 3) continue;
    heights.push_back(z);
    raw.push_back(geometry::length_of(tape, true));
  }
  const int count = static_cast<int>(raw.size());
  if (count <= 2 * kEnd + 2) return std::nullopt;
  std::vector<double> girths(count);
  for (int i = 0; i < count; ++i) {
    double sum = 0, weight = 0;
    for (int k = -8; k <= 8; ++k) {
      const double w = std::exp(-0.5 * k * k / (kSmoothing * kSmoothing));
      int j = i + k;  // mirrored at the ends
      if (j < 0) j = -1 - j;
      if (j >= count) j = 2 * count - 1 - j;
      sum += w * raw[j];
      weight += w;
    }
    girths[i] = sum / weight;
  }
  const int least = static_cast<int>(std::min_element(girths.begin(), girths.end()) - girths.begin());
  if (least < kEnd || least >= count - kEnd) return std::nullopt;
  std::vector<int> near;
  for (int i = 0; i < count; ++i)
    if (std::abs(heights[i] - heights[least]) < kBottom) near.push_back(i);
  Eigen::MatrixXd terms(near.size(), 3);
  Eigen::VectorXd values(near.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double d = heights[near[i]] - heights[least];
    terms.row(static_cast<int>(i)) << 1, d, d * d;
    values[static_cast<int>(i)] = girths[near[i]];
  }
  const Eigen::Vector3d c = terms.colPivHouseholderQr().solve(values);
  return heights[least] + (c[2] > 0 ? std::clamp(-c[1] / (2 * c[2]), -kMoved, kMoved) : 0);
}

std::optional<Vector3d> find_crotch(const Surface& surface, const Vector3d& expected) {
  std::vector<Vector3d> near;  // of the midline that comes nearest
  double nearest = kPerineumReach;
  for (const geometry::SectionLoop& loop :
       cut(surface, expected, Vector3d::UnitY(), [](const Eigen::Vector3i&) { return true; })) {
    std::vector<Vector3d> points;
    double far = nearest;
    for (const Vector3d& p : loop.points) {
      far = std::min(far, (p - expected).norm());
      if ((p - expected).norm() < kMidline) points.push_back(p);
    }
    if (far >= nearest) continue;
    nearest = far;
    near = std::move(points);
  }
  if (near.empty()) return std::nullopt;
  const Vector3d lowest = *std::min_element(
      near.begin(), near.end(), [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
  // Lower still further on: thighs that touch, or skin that fills the gap between them.
  if ((lowest - expected).norm() > kMidline - kPerineumReach / 4) return std::nullopt;
  return lowest;
}

}  // namespace tensegric_fit::landmarks
