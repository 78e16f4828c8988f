#include "landmarks/neck.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "landmarks/neck_growth.hpp"
#include "landmarks/neck_plane.hpp"
#include "landmarks/profile.hpp"
#include "landmarks/throat.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kHighest = 0.93;    // of stature: the mouth; a neck is lower
constexpr double kLower = 0.08;      // statures under the thinnest level section, where a stooped neck can be
constexpr double kNeckToHead = 0.7;  // a neck's section is smaller than this share of the head's

// In statures, with the girth in statures too: fat under the chin lowers the corner, and a thick neck is
// hardly thinner anywhere. Along the skin from the corner under the chin down to the girth's plane and to the
// notch. `throat` is the way from there to where the throat is deepest: a head that is held up on a stooped
// back stretches it. Along the axis from the plane down to vertebra and neck side.
constexpr double kGirth = 0.188, kThroat = 0.037, kShortest = 0.010, kLongest = 0.065;
double plane_below_corner(double girth, double throat) {
  return 0.0220 + 0.022 * (girth - kGirth) + 0.278 * (throat - kThroat);
}
double notch_below_corner(double girth, double throat) {
  return 0.0362 + 0.072 * (girth - kGirth) + 0.608 * (throat - kThroat);
}
constexpr double kCone =
    0.24;  // girth of a neck that is nowhere thinner than where it grows out of the trunk
constexpr double kPlaneAboveDeepest = 0.0141;  // where chin and neck make no corner
double side_below_plane(double girth) {
  return 0.0108 - 0.105 * (girth - kGirth);
}
constexpr double kBackBelowPlane = 0.0383, kSideForwards = 0.003;

// Lean of the plane of the neck's base: the mean of what two planes tell, that of the least girth through its
// middle, `here`, and that of the thinnest loop, which a stretched throat leaves behind. A thick neck's girth
// hardly depends on the lean, so that either alone is uncertain.
double base_lean(double here, double thinnest, double girth, double throat) {
  const double thick = girth - kGirth, stretched = throat - kThroat;
  const double by_least = here + std::clamp(-160 * thick, -3.0, 4.0) * kDegree;
  const double by_thinnest =
      (25.7 + 70 * thick + 380 * stretched) * kDegree + 0.85 * (thinnest - 22 * kDegree);
  return (by_least + by_thinnest) / 2;
}

// Area of the trunk's section: the median of five levels, since at lips and ears one section can fall into
// pieces.
double steady_area(const std::vector<Level>& levels, int at) {
  std::vector<double> areas;
  for (int i = std::max(0, at - 2); i <= std::min(static_cast<int>(levels.size()) - 1, at + 2); ++i)
    areas.push_back(levels[i].trunk < 0 ? 0 : levels[i].outlines[levels[i].trunk].area);
  std::nth_element(areas.begin(), areas.begin() + areas.size() / 2, areas.end());
  return areas[areas.size() / 2];
}

// The level between axillae and head at which trunk and neck are thinnest, or -1.
int thinnest_level(const BodyShape& body, const Trunk& trunk) {
  const std::vector<Level>& levels = body.levels.levels;
  int thinnest = -1;
  double least = 1e9, widest_above = 0;
  for (int i = static_cast<int>(levels.size()) - 1; i > 0 && levels[i].height > trunk.axilla_height(); --i) {
    const double area = steady_area(levels, i);
    widest_above = std::max(widest_above, area);
    if (levels[i].trunk < 0 || levels[i].height > kHighest * body.stature ||
        area > kNeckToHead * widest_above)
      continue;
    if (area >= least) continue;
    least = area;
    thinnest = i;
  }
  return thinnest;
}

// A place in the neck, from a level section that is thin. The neck leans: on a stooped body level sections
// are thinnest at the mouth.
Vector3d place_in_neck(const BodyShape& body, const Trunk& trunk, int thinnest) {
  const std::vector<Level>& levels = body.levels.levels;
  const double lowest = std::max(levels[thinnest].height - kLower * body.stature, trunk.axilla_height());
  Vector3d place = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int i = thinnest; i > 0 && levels[i].height > lowest; i -= 2) {
    if (levels[i].trunk < 0) continue;
    const Eigen::Vector2d& centre = levels[i].outlines[levels[i].trunk].centroid;
    const Vector3d middle(centre.x(), centre.y(), levels[i].height);
    const double girth = NeckPlanes(body, middle).girth(middle, kUprightLean);
    if (girth >= least) continue;
    least = girth;
    place = middle;
  }
  return place;
}

// The thinnest loop round the neck, whatever its lean.
NeckPlane thinnest_plane(const NeckPlanes& planes, const Vector3d& middle, double stature) {
  NeckPlane plane{middle, 0};
  for (int pass = 0; pass < 4; ++pass) {
    plane.lean = planes.least_lean(plane.origin);
    plane.origin = planes.middle_of_tape(plane.origin, plane.lean);
    const Vector3d axis = NeckPlanes::normal_of(plane.lean), start = plane.origin;
    double least = planes.girth(start, plane.lean);
    for (int step = -4; step <= 4; ++step) {
      const Vector3d origin = start + 0.004 * stature * step * axis;
      const double girth = planes.girth(origin, plane.lean);
      if (girth >= least) continue;
      least = girth;
      plane.origin = origin;
    }
    const bool settled = plane.origin == start;
    plane.origin = planes.middle_of_tape(plane.origin, plane.lean);
    if (settled) break;
  }
  return plane;
}

}  // namespace

Neck find_neck(const BodyShape& body, const Trunk& trunk) {
  const double s = body.stature;
  Neck neck;
  if (!body.levels.has_head) {
    neck.missing = "no neck and head";
    return neck;
  }
  neck.missing = "no neck thinner than the head was found";
  const int level = thinnest_level(body, trunk);
  if (level < 0) return neck;
  const Vector3d place = place_in_neck(body, trunk, level);
  const NeckPlanes planes(body, place);

  // 1. The thinnest loop, and from its front the corner under the chin.
  const NeckPlane thinnest = thinnest_plane(planes, place, s);
  const ThroatProfile front = find_throat(body, thinnest);
  if (front.deepest < 0) return neck;
  const bool has_corner = front.corner >= 0;
  const double throat =
      std::clamp((front.deepest - front.corner) * front.profile.step / s, kShortest, kLongest);
  const double least = planes.girth(thinnest.origin, thinnest.lean);
  double lean = thinnest.lean, girth = least / s;
  if (!has_corner) {
    neck.confidence = 0.45;
    neck.reason = "no corner between chin and neck; from the deepest point of the throat";
  }

  // 2. The girth is the least one round the middle of the neck's base, a given way below that corner.
  neck.origin = thinnest.origin;
  for (int pass = 0; pass < 3; ++pass) {
    const Vector3d anchor = has_corner ? front.along(front.corner, plane_below_corner(girth, throat) * s)
                                       : front.along(front.deepest, -kPlaneAboveDeepest * s);
    const double base = base_lean(lean, thinnest.lean, girth, throat);
    const Vector3d axis = NeckPlanes::normal_of(base);
    neck.origin += axis.dot(anchor - neck.origin) * axis;
    neck.origin += offset_by_growth(planes, {neck.origin, base}, least, s) * axis;
    neck.origin = planes.middle_of_tape(neck.origin, base);
    lean = planes.least_lean(neck.origin);
    neck.tape = planes.tape(neck.origin, lean);
    if (neck.tape.empty()) return neck;
    neck.girth = geometry::length_of(neck.tape, true);
    girth = neck.girth / s;
  }
  if (girth > kCone && neck.reason.empty()) {
    neck.confidence = 0.45;
    neck.reason = "a thick neck: its girth grows fast towards the trunk";
  }
  neck.front = has_corner ? front.along(front.corner, notch_below_corner(girth, throat) * s)
                          : front.profile.points[front.deepest];
  const double base = base_lean(lean, thinnest.lean, girth, throat);
  neck.axis = NeckPlanes::normal_of(base);
  neck.forwards = {std::cos(base), 0, -std::sin(base)};
  neck.turn = base - kUprightLean;
  neck.base_up = has_corner ? neck.axis : NeckPlanes::normal_of(neck.turn);
  neck.base = has_corner ? Vector3d(neck.origin - kBackBelowPlane * s * neck.axis) : neck.front;
  neck.found = true;
  return neck;
}

Vector3d find_neck_back(const BodyShape& body, const Neck& neck) {
  const double s = body.stature;
  const Vector3d reach = Vector3d(0.12, 0.01, 0.12) * s;
  const Vector3d wanted = neck.origin + neck.base_up.dot(neck.base - neck.origin) * neck.base_up;
  Vector3d nape = wanted - 0.03 * s * neck.forwards;
  double nearest = 1e9;
  const std::vector<int> skin = triangles_in_box(body, wanted - reach, wanted + reach);
  for (const geometry::SectionLoop& loop : cut(body, skin, neck.origin, Vector3d::UnitY())) {
    for (const Vector3d& p : loop.points) {
      const double off = std::abs(neck.base_up.dot(p - wanted));
      if (neck.forwards.dot(p - wanted) > 0 || off >= nearest) continue;
      nearest = off;
      nape = p;
    }
  }
  return nape;
}

Vector3d find_neck_side(const BodyShape& body, const Neck& neck, Side side) {
  const double s = body.stature, sign = kSign[side];
  const Vector3d wanted =
      neck.origin + kSideForwards * s * neck.forwards - side_below_plane(neck.girth / s) * s * neck.axis;
  const Vector3d reach = Vector3d(0.03, 0.08, 0.05) * s;
  Vector3d place = wanted + Vector3d(0, sign * 0.035 * s, 0);
  double nearest = 1e9;
  const std::vector<int> skin = triangles_in_box(body, wanted - reach, wanted + reach);
  for (const geometry::SectionLoop& loop : cut(body, skin, wanted, neck.forwards)) {
    for (const Vector3d& p : loop.points) {
      const double off = std::abs(neck.axis.dot(p - wanted));
      if (sign * (p.y() - wanted.y()) < 0.01 * s || off >= nearest) continue;
      nearest = off;
      place = p;
    }
  }
  return place;
}

}  // namespace tensegric_fit::landmarks
