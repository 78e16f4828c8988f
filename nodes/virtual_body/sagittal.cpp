#include "virtual_body/sagittal.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "geometry/parabola.hpp"
#include "geometry/points.hpp"
#include "geometry/section.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;
using Line = std::vector<Vector3d>;

constexpr double kStep = 0.001;   // m along a profile
constexpr double kSmoothing = 4;  // steps: deviation of the Gaussian that takes facets out of its curvature
constexpr double kNipple = 0.020, kReach = 0.170,
                 kBeyond = 0.080;  // m down from a bust point: a fold lies in between
constexpr double kWay = 0.150;     // m of a profile that show which way is down
constexpr double kMedial = 0.055, kFirstMedial = 0.010, kMedialStep = 0.005;  // m towards the middle
constexpr double kContinued = 0.3, kMostRise = 0.012;  // of its curvature, m: less, more is another hollow
constexpr double kNearlyAsHollow = 0.8;
constexpr int kRivalSteps = 12, kOpeningSteps = 20;
constexpr double kBesideMiddle = 0.010;  // m: a buttock's profiles to both sides of the middle one
constexpr double kNarrow = 0.025,
                 kWide = 0.040;  // m up and down of its apex; the wider where the skin is flat
constexpr double kDeep = 0.020, kMoved = 0.020;  // m before the rearmost, m that the apex may be off it
constexpr double kRound = 1;                     // 1/m: a parabola's factor; with less it has no apex
constexpr double kFlatDepth = 0.0003, kFlatReach = 0.060, kBesideCrotch = 0.020;  // m
constexpr double kRoundPerineum = 0.060, kFloor = 0.002;                          // m

/// In steps of kStep, as far as `length`.
Line even(const Line& line, double length) {
  Line result{line.front()};
  double gone = 0;  // to the start of the segment
  for (std::size_t i = 1; i < line.size() && gone < length; ++i) {
    const double whole = (line[i] - line[i - 1]).norm();
    for (double at = kStep * static_cast<double>(result.size()); at <= std::min(gone + whole, length);
         at = kStep * static_cast<double>(result.size()))
      result.push_back(line[i - 1] + (at - gone) / whole * (line[i] - line[i - 1]));
    gone += whole;
  }
  return result;
}

/// The trunk's profile from the place nearest to `start` down the front.
Line profile_down(const Skin& skin, const Vector3d& start) {
  Line loop = skin.sagittal(start, Part::trunk).points;
  if (loop.size() < 3) return {};
  const auto nearest = std::min_element(loop.begin(), loop.end(), [&](const Vector3d& a, const Vector3d& b) {
    return (a - start).squaredNorm() < (b - start).squaredNorm();
  });
  std::rotate(loop.begin(), nearest, loop.end());
  Line back = loop;
  std::reverse(back.begin() + 1, back.end());
  const auto height = [](const Line& way) { return geometry::mean_of(even(way, kWay)).z(); };
  if (height(back) < height(loop)) loop = back;
  return geometry::smoothed(even(loop, kReach + kBeyond), kSmoothing, static_cast<int>(4 * kSmoothing));
}

/// Positive where the profile of a front that is followed downwards is hollow.
std::vector<double> curvature_of(const Line& profile) {
  std::vector<double> curvature(profile.size(), 0);
  for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
    const Vector3d a = profile[i] - profile[i - 1], b = profile[i + 1] - profile[i];
    curvature[i] = std::atan2(b.cross(a).y(), a.dot(b)) / ((a.norm() + b.norm()) / 2);
  }
  return curvature;
}

std::optional<Fold> fold_at(const Skin& skin, const Vector3d& bust_point) {
  const Line profile = profile_down(skin, bust_point);
  const std::vector<double> curvature = curvature_of(profile);
  const int first = static_cast<int>(kNipple / kStep) + 1,
            end = std::min(static_cast<int>(kReach / kStep), static_cast<int>(profile.size()) - 1);
  if (first >= end) return std::nullopt;
  const int best = static_cast<int>(std::max_element(curvature.begin() + first, curvature.begin() + end) -
                                    curvature.begin());
  if (curvature[best] <= 0) return std::nullopt;
  Fold fold{profile[best], profile[best], curvature[best]};
  const auto hollow = [&](int i) {
    return i >= first && i < end && curvature[i] > kNearlyAsHollow * curvature[best];
  };
  int low = best, high = best;
  while (hollow(low - 1)) --low;
  while (hollow(high + 1)) ++high;
  fold.width = kStep * (high - low + 1);
  for (int i = first; i < end; ++i) fold.rival |= hollow(i) && std::abs(i - best) > kRivalSteps;
  const int last = static_cast<int>(profile.size()) - 1;
  const Vector3d up = profile[std::max(best - kOpeningSteps, 0)] - profile[best],
                 down = profile[std::min(best + kOpeningSteps, last)] - profile[best];
  fold.opening = std::atan2(up.cross(down).norm(), up.dot(down));
  return fold;
}

/// Apex of one profile, as far as it has one: how far above `rearmost`, and its x there.
struct Apex {
  double up, x;
};

Apex apex_of(const Line& profile, const Vector3d& rearmost) {
  for (const double reach : {kNarrow, kWide}) {
    geometry::Parabola parabola;
    for (const Vector3d& p : profile) {
      const double d = (p.z() - rearmost.z()) / reach, x = p.x() - rearmost.x();
      if (std::abs(d) < 1 && x < kDeep) parabola.add(d, x);
    }
    if (parabola.count() < 3) continue;
    const Vector3d c = parabola.coefficients();
    if (c[2] / (reach * reach) <= kRound) continue;
    const double up = std::clamp(-c[1] / (2 * c[2]), -kMoved / reach, kMoved / reach);
    return {reach * up, rearmost.x() + c[0] + up * (c[1] + up * c[2])};
  }
  return {0, rearmost.x()};
}

}  // namespace

std::optional<Fold> find_fold(const Skin& skin, const Vector3d& bust_point, Side side) {
  std::optional<Fold> fold = fold_at(skin, bust_point);
  if (!fold) return fold;
  double last = fold->place.z();
  const int steps = static_cast<int>(std::lround((kMedial - kFirstMedial) / kMedialStep));
  for (int i = 0; i <= steps; ++i) {
    const double medial = kFirstMedial + i * kMedialStep;
    const auto next = fold_at(skin, bust_point - kSign[side] * medial * Vector3d::UnitY());
    if (!next || next->curvature <= kContinued * fold->curvature ||
        std::abs(next->place.z() - last) >= kMostRise)
      break;
    last = next->place.z();
    if (last < fold->lowest.z()) fold->lowest = next->place;
  }
  return fold;
}

Buttock find_buttock(const Skin& skin, const Vector3d& rearmost) {
  std::vector<Apex> apexes;
  Buttock buttock{rearmost};
  for (const double beside : {-kBesideMiddle, 0.0, kBesideMiddle}) {
    const auto loop = skin.sagittal(rearmost + beside * Vector3d::UnitY(), Part::trunk);
    if (loop.points.empty()) continue;
    const Line profile = even(loop.points, geometry::length_of(loop.points, false));
    apexes.push_back(apex_of(profile, rearmost));
    if (beside != 0) continue;
    double low = rearmost.z(), high = rearmost.z();
    for (const Vector3d& p : profile) {
      if (std::abs(p.z() - rearmost.z()) >= kFlatReach || p.x() >= rearmost.x() + kFlatDepth) continue;
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    buttock.flat = high - low;
  }
  if (apexes.empty()) return buttock;
  std::sort(apexes.begin(), apexes.end(), [](const Apex& a, const Apex& b) { return a.up < b.up; });
  const Apex& middle = apexes[apexes.size() / 2];
  buttock.apex = Vector3d(middle.x, rearmost.y(), rearmost.z() + middle.up);
  return buttock;
}

std::optional<Vector3d> rearmost_vertex(const Skin& skin, Side side, double middle, double low, double high) {
  std::optional<Vector3d> rearmost;
  for (const Vector3d& p : skin.mesh(Part::trunk).vertices)
    if (kSign[side] * (p.y() - middle) > kBesideCrotch && p.z() > low && p.z() < high &&
        (!rearmost || p.x() < rearmost->x()))
      rearmost = p;
  return rearmost;
}

Crotch find_crotch(const Skin& skin, const Vector3d& perineum) {
  const Line midline = skin.sagittal(perineum, Part::whole).points;
  const auto near = [&](const Vector3d& p) { return (p - perineum).norm() < kRoundPerineum; };
  const Vector3d* lowest = nullptr;
  for (const Vector3d& p : midline)
    if (near(p) && (lowest == nullptr || p.z() < lowest->z())) lowest = &p;
  if (lowest == nullptr)
    throw geometry::Refusal(geometry::refusal::kBadMesh, "there is no skin between the legs");
  Crotch crotch{*lowest};
  double back = lowest->x(), front = lowest->x();
  for (const Vector3d& p : midline) {
    if (!near(p) || p.z() >= lowest->z() + kFloor) continue;
    back = std::min(back, p.x());
    front = std::max(front, p.x());
  }
  crotch.flat = front - back;
  return crotch;
}

}  // namespace tensegric_fit::virtual_body
