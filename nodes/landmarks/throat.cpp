#include "landmarks/throat.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kCorner = 15;  // 1/m: chin and neck meet in a corner more hollow than that
// From the corner to the throat skin turns by so much at most; more is a filling that sags into the chin,
// where no sensor looked up. So far down along the skin (metres) the bend is over.
constexpr double kMostTurn = 35 * kDegree, kBendAbove = 0.014, kBendBelow = 0.028, kLongestSag = 0.015;

// Front of chin, neck and chest in the middle, from top to bottom.
Profile front_of_neck(const BodyShape& body, const Vector3d& middle) {
  const double s = body.stature;
  return cut_profile(body,
                     triangles_in_box(body, middle + Vector3d(-0.02 * s, -0.01 * s, -0.07 * s),
                                      middle + Vector3d(0.12 * s, 0.01 * s, 0.07 * s)),
                     middle, Vector3d::UnitX());
}

// Where chin and neck meet: the most hollow point round the height of the thinnest loop, or -1.
int corner_under_chin(const Profile& front, const NeckPlane& thinnest, double stature) {
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
  const auto most_hollow = [&front](int first, int last, int reach, double least) {
    int most = -1;
    for (int i = std::max(0, first); i <= last; ++i) {
      if (front.hollowness(i, reach) <= least) continue;
      least = front.hollowness(i, reach);
      most = i;
    }
    return most;
  };
  const int corner = most_hollow(level - up, level + down, 8, kCorner);
  // Sensors see little of a chin from below: the middle of the bend is surer than its sharpest place.
  const int near = static_cast<int>(0.006 * stature / front.step);
  return corner < 0 ? -1 : std::max(corner - near, most_hollow(corner - near, corner + near, 14, -1e9));
}

// The same place on the near side of a filling under the chin: down to where the skin has begun to turn into
// the throat's direction.
int below_sagging_skin(const Profile& front, int corner) {
  const int last = static_cast<int>(front.points.size()) - 1;
  const auto steps = [&front](double length) { return static_cast<int>(std::lround(length / front.step)); };
  const auto direction = [&](int from, int to) {
    const Vector3d way = front.points[std::clamp(to, 0, last)] - front.points[std::clamp(from, 0, last)];
    return std::atan2(way.x(), -way.z());
  };
  const int near = steps(0.004);
  for (int at = corner; at < corner + steps(kLongestSag); ++at)
    if (direction(at - near, at + near) >
        direction(at + steps(kBendAbove), at + steps(kBendBelow)) - kMostTurn)
      return at;
  return std::min(corner + steps(kLongestSag), last);
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
  const int bend = corner_under_chin(front, thinnest, body.stature);
  const int corner = bend < 0 ? -1 : below_sagging_skin(front, bend);
  return {front, corner, deepest_point(front, thinnest, corner)};
}

}  // namespace tensegric_fit::landmarks
