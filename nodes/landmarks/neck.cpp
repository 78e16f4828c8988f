#include "landmarks/neck.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
// In statures. The neck's girth is taken a little above its base: 40 mm above the notch at the throat.
constexpr double kPlaneAboveNotch = 0.0236;
constexpr double kHighest = 0.93;    // of stature: the mouth; a neck is lower
constexpr double kNeckToHead = 0.7;  // a neck's section is smaller than this share of the head's
constexpr double kRadius = 0.085;    // a thick neck is within, shoulders and chin are not

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
  if (!body.levels.has_head) return -1;
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

// The tape round the neck in the plane through `origin` leaning forward by `lean`; empty where it is not
// closed.
std::vector<Vector3d> neck_tape(const BodyShape& body, const std::vector<int>& skin, const Vector3d& origin,
                                double lean) {
  const Vector3d normal(std::sin(lean), 0, std::cos(lean));
  const geometry::SectionLoop* around = nullptr;
  double nearest = kRadius * body.stature;
  const std::vector<geometry::SectionLoop> loops = cut(body, skin, origin, normal);
  for (const geometry::SectionLoop& loop : loops) {
    if (!loop.closed) continue;
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : loop.points) mean += p / static_cast<double>(loop.points.size());
    if ((mean - origin).norm() < nearest && loop.points.size() > 20) {
      nearest = (mean - origin).norm();
      around = &loop;
    }
  }
  return around == nullptr ? std::vector<Vector3d>() : geometry::tape(around->points, normal);
}

// The notch at the throat: where the front profile, running down from the chin, stops receding and turns to
// the chest.
bool find_notch(const BodyShape& body, const Vector3d& neck_middle, Vector3d& notch) {
  const double s = body.stature;
  const std::vector<int> skin = triangles_in_box(body, neck_middle + Vector3d(0, -0.01 * s, -0.07 * s),
                                                 neck_middle + Vector3d(0.12 * s, 0.01 * s, 0.005 * s));
  const Profile front = cut_profile(body, skin, neck_middle, Vector3d::UnitX());
  int deepest = -1;
  for (int i = 0; i < static_cast<int>(front.points.size()); ++i)
    if (deepest < 0 || front.points[i].x() < front.points[deepest].x()) deepest = i;
  if (deepest < 0) return false;
  // Middle of the stretch that is as deep to 0.3 mm: noise moves a single point by centimetres.
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const Vector3d& p : front.points) {
    if (p.x() > front.points[deepest].x() + 0.0003) continue;
    sum += p;
    ++count;
  }
  notch = sum / count;
  return true;
}

}  // namespace

Neck find_neck(const BodyShape& body, const Trunk& trunk) {
  Neck neck;
  const int level = thinnest_level(body, trunk);
  if (level < 0) return neck;
  const Level& thinnest = body.levels.levels[level];
  const Eigen::Vector2d& centre = thinnest.outlines[thinnest.trunk].centroid;
  const Vector3d middle(centre.x(), centre.y(), thinnest.height);
  if (!find_notch(body, middle, neck.front)) return neck;

  // The plane's origin is the middle of its own loop, a fixed way above the notch; its lean is the one of
  // least girth.
  const double s = body.stature, radius = kRadius * s;
  neck.origin = {middle.x(), middle.y(), neck.front.z() + kPlaneAboveNotch * s};
  const std::vector<int> skin = triangles_in_box(body, neck.origin - Vector3d(radius, radius, radius),
                                                 neck.origin + Vector3d(radius, radius, radius));
  double lean = 0;
  for (int pass = 0; pass < 3; ++pass) {
    double least = 1e9;
    for (double angle = 0; angle <= 45 * kDegree; angle += 1.5 * kDegree) {
      const double girth = geometry::length_of(neck_tape(body, skin, neck.origin, angle), true);
      if (girth <= 0 || girth >= least) continue;
      least = girth;
      lean = angle;
    }
    neck.tape = neck_tape(body, skin, neck.origin, lean);
    if (neck.tape.empty()) return neck;
    Vector3d low = neck.tape.front(), high = low;
    for (const Vector3d& p : neck.tape) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    neck.origin.head<2>() = (low + high).head<2>() / 2;
  }
  neck.tape = neck_tape(body, skin, neck.origin, lean);
  neck.axis = {std::sin(lean), 0, std::cos(lean)};
  neck.girth = geometry::length_of(neck.tape, true);
  neck.found = !neck.tape.empty();
  return neck;
}

Vector3d find_neck_back(const BodyShape& body, const Neck& neck) {
  const double s = body.stature;
  const Vector3d at(neck.origin.x(), neck.origin.y(), neck.front.z());
  const std::vector<int> skin = triangles_in_box(body, at + Vector3d(-0.12 * s, -0.01 * s, -0.03 * s),
                                                 at + Vector3d(0, 0.01 * s, 0.04 * s));
  const Profile back = cut_profile(body, skin, at, -Vector3d::UnitX());
  Vector3d nape = at - Vector3d(0.045 * s, 0, 0);
  double nearest = 1e9;
  for (const Vector3d& p : back.points) {
    if (std::abs(p.z() - at.z()) >= nearest) continue;
    nearest = std::abs(p.z() - at.z());
    nape = p;
  }
  return nape;
}

Vector3d find_neck_side(const BodyShape& body, const Neck& neck, Side side) {
  // Where the line from neck to shoulder is as steep as it is flat.
  const double s = body.stature, sign = kSign[side];
  const Vector3d low = neck.origin + Vector3d(-0.01 * s, sign > 0 ? 0 : -0.1 * s, -0.05 * s);
  const Vector3d high = neck.origin + Vector3d(0.01 * s, sign > 0 ? 0.1 * s : 0, 0.03 * s);
  const Profile slope =
      cut_profile(body, triangles_in_box(body, low, high), neck.origin, sign * Vector3d::UnitY());
  const int reach = 10;
  for (int i = reach; i + reach < static_cast<int>(slope.points.size()); ++i) {
    const Vector3d run = slope.points[i + reach] - slope.points[i - reach];
    if (std::abs(run.y()) > std::abs(run.z())) return slope.points[i];
  }
  return neck.origin + Vector3d(0, sign * 0.035 * s, -0.012 * s);
}

}  // namespace tensegric_fit::landmarks
