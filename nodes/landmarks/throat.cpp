#include "landmarks/throat.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kCorner = 15;  // 1/m: chin and neck meet in a corner more hollow than that
// Under a chin, the corner is where skin has turned by that share of the way from the chin's direction into
// the neck's. Directions are looked at over so many metres each way; a chin begins so far above the sharpest
// place of the bend, and the corner is near it. Skin that runs further back than that is a mouth's.
constexpr double kTurned = 0.3, kChinSeen = 0.020, kBendSeen = 0.008, kChin = 0.040, kNear = 0.020;
constexpr double kMouth = 125 * kDegree;

// Front of chin, neck and chest in the middle, from top to bottom.
Profile front_of_neck(const BodyShape& body, const Vector3d& middle) {
  const double s = body.stature;
  return cut_profile(body,
                     triangles_in_box(body, middle + Vector3d(-0.02 * s, -0.01 * s, -0.07 * s),
                                      middle + Vector3d(0.12 * s, 0.01 * s, 0.07 * s)),
                     middle, Vector3d::UnitX());
}

// The sharpest place of the bend from chin to neck, round the height of the thinnest loop, or -1.
int sharpest_of_bend(const Profile& front, const NeckPlane& thinnest, double stature) {
  const Vector3d axis = NeckPlanes::normal_of(thinnest.lean);
  int level = -1;
  double nearest = 0.01 * stature;
  for (int i = 0; i < static_cast<int>(front.points.size()); ++i) {
    const double off = std::abs(axis.dot(front.points[i] - thinnest.origin));
    if (off >= nearest) continue;
    nearest = off;
    level = i;
  }
  if (level < 0) return -1;
  const int up = static_cast<int>(0.030 * stature / front.step),
            down = static_cast<int>(0.012 * stature / front.step);
  double least = kCorner;
  int most = -1;
  for (int i = std::max(0, level - up); i <= level + down; ++i) {
    if (front.hollowness(i, 8) <= least) continue;
    least = front.hollowness(i, 8);
    most = i;
  }
  return most;
}

// Direction of the skin at a point: radians from straight down, forwards.
double direction_at(const Profile& front, int at, double reach) {
  const int steps = static_cast<int>(std::lround(reach / front.step)),
            last = static_cast<int>(front.points.size()) - 1;
  const Vector3d way =
      front.points[std::clamp(at + steps, 0, last)] - front.points[std::clamp(at - steps, 0, last)];
  return std::atan2(way.x(), -way.z());
}

// The corner, from the sharpest place of the bend. A direction is surer than that place, most of all where no
// sensor looked up and a filling sags into the chin; a stoop takes it along.
int corner_of_bend(const Profile& front, int sharpest, double lean) {
  const auto steps = [&front](double length) { return static_cast<int>(std::lround(length / front.step)); };
  double chin = 0;
  for (int i = std::max(0, sharpest - steps(kChin)); i <= sharpest; ++i)
    chin = std::min(chin, direction_at(front, i, kChinSeen));
  const double turned = (1 - kTurned) * std::max(chin, -kMouth) - kTurned * lean;
  const int first = std::max(0, sharpest - steps(kNear));
  int at = std::min(sharpest + steps(kNear), static_cast<int>(front.points.size()) - 1);
  while (at > first && direction_at(front, at, kBendSeen) > turned) --at;
  return at;
}

// Where the throat's profile, running down along the neck from `corner` or the thinnest loop, stops receding,
// or -1.
int deepest_point(const Profile& front, const NeckPlane& thinnest, int corner) {
  const Vector3d loop_axis = NeckPlanes::normal_of(thinnest.lean);
  const Vector3d axis = NeckPlanes::normal_of(thinnest.lean - kUprightLean), forwards(axis.z(), 0, -axis.x());
  const int count = static_cast<int>(front.points.size());
  int first = count;  // an open mouth can reach below the loop's front
  while (first > 0 && loop_axis.dot(front.points[first - 1] - thinnest.origin) < 0) --first;
  int deepest = -1;
  for (int i = corner >= 0 ? corner : first; i < count; ++i)
    if (deepest < 0 || forwards.dot(front.points[i] - front.points[deepest]) < -1e-9) deepest = i;
  return deepest;
}

}  // namespace

const Vector3d& ThroatProfile::along(int from, double length) const {
  const int at = from + static_cast<int>(std::lround(length / profile.step));
  return profile.points[std::clamp(at, 0, static_cast<int>(profile.points.size()) - 1)];
}

ThroatProfile find_throat(const BodyShape& body, const NeckPlane& thinnest) {
  const Profile front = front_of_neck(body, thinnest.origin);
  const int sharpest = sharpest_of_bend(front, thinnest, body.stature);
  const int corner = sharpest < 0 ? -1 : corner_of_bend(front, sharpest, thinnest.lean);
  return {front, corner, deepest_point(front, thinnest, corner)};
}

}  // namespace tensegric_fit::landmarks
