#include "landmarks/neck_plane.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kRadius = 0.11;  // statures round the neck's middle: a thick neck's leaning plane is within
constexpr double kOffMiddle = 0.06;  // statures; the loop round an arm or a shoulder is further off
constexpr double kThinnest = 0.145, kThickest = 0.40;  // statures; less is the mouth's inside, more a chest
constexpr double kNone = 1e9;

}  // namespace

NeckPlanes::NeckPlanes(const BodyShape& body, const Vector3d& middle) : body_(body) {
  const Vector3d radius = Vector3d::Constant(kRadius * body.stature);
  skin_ = triangles_in_box(body, middle - radius, middle + radius);
}

Vector3d NeckPlanes::normal_of(double lean) {
  return {std::sin(lean), 0, std::cos(lean)};
}

std::vector<Vector3d> NeckPlanes::tape(const Vector3d& origin, double lean) const {
  const Vector3d normal = normal_of(lean);
  const std::vector<geometry::SectionLoop> loops = cut(body_, skin_, origin, normal);
  const geometry::SectionLoop* around = nullptr;
  double nearest = kOffMiddle * body_.stature;
  for (const geometry::SectionLoop& loop : loops) {
    if (!loop.closed || loop.points.size() <= 20) continue;
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : loop.points) mean += p / static_cast<double>(loop.points.size());
    if ((mean - origin).norm() >= nearest) continue;
    nearest = (mean - origin).norm();
    around = &loop;
  }
  if (around == nullptr) return {};
  std::vector<Vector3d> round = geometry::tape(around->points, normal);
  const double girth = geometry::length_of(round, true) / body_.stature;
  return girth < kThinnest || girth > kThickest ? std::vector<Vector3d>() : round;
}

double NeckPlanes::girth(const Vector3d& origin, double lean) const {
  const std::vector<Vector3d> round = tape(origin, lean);
  return round.empty() ? kNone : geometry::length_of(round, true);
}

double NeckPlanes::least_lean(const Vector3d& origin) const {
  double best = 25 * kDegree, reach = 36 * kDegree;
  for (const double step : {6 * kDegree, 1 * kDegree}) {
    const double middle = best;
    double least = kNone;
    for (double lean = std::max(0.0, middle - reach); lean <= middle + reach; lean += step) {
      const double here = girth(origin, lean);
      if (here >= least) continue;
      least = here;
      best = lean;
    }
    reach = step;
  }
  return best;
}

Vector3d NeckPlanes::middle_of_tape(const Vector3d& origin, double lean) const {
  const std::vector<Vector3d> round = tape(origin, lean);
  if (round.empty()) return origin;
  Vector3d low = round.front(), high = low;
  for (const Vector3d& p : round) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (low + high) / 2;  // in the plane: x and z of a leaning tape reach their ends together
}

}  // namespace tensegric_fit::landmarks
