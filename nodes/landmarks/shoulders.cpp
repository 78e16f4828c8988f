#include "landmarks/shoulders.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kApart = 0.005;
constexpr double kSlopeAtAcromion = 0.81;  // 39 degrees: where the shoulder's line turns down into the arm
constexpr double kBeyondAxilla = 0.022;  // statures: the acromion is over the arm, half an arm's breadth out
constexpr double kBehindRidge = 0.0195;  // statures: acromia lie behind the ridge of the shoulder ...
constexpr double kBehindNeck =
    0.0305;  // ... and behind the middle of the neck; each errs by a centimetre, not together
constexpr double kNearest = 0.06, kFurthest = 0.16;  // statures from the neck's middle

// Top of the shoulder in the sagittal plane y: the middle of its highest two millimetres, where noise moves
// the highest point.
bool ridge_at(const BodyShape& body, const std::vector<int>& skin, double y, Vector3d& ridge) {
  double top = -1;
  const std::vector<geometry::SectionLoop> loops = cut(body, skin, {0, y, 0}, Vector3d::UnitY());
  for (const geometry::SectionLoop& loop : loops)
    for (const Vector3d& p : loop.points) top = std::max(top, p.z());
  double back = 1e9, front = -1e9;
  for (const geometry::SectionLoop& loop : loops) {
    for (const Vector3d& p : loop.points) {
      if (p.z() < top - 0.002) continue;
      back = std::min(back, p.x());
      front = std::max(front, p.x());
    }
  }
  ridge = {(back + front) / 2, y, top};
  return top > 0;
}

// Distance from the neck's middle at which the ridge turns down, or -1: an arm that is raised.
double turning_down(const std::vector<double>& distances, const std::vector<double>& heights) {
  const int reach = 4;  // 20 mm each way
  std::vector<double> slopes(distances.size(), 0);
  int flattest = -1;
  for (int i = reach; i + reach < static_cast<int>(distances.size()); ++i) {
    slopes[i] = (heights[i - reach] - heights[i + reach]) / (distances[i + reach] - distances[i - reach]);
    if (flattest < 0 || (slopes[i] < slopes[flattest] && slopes[flattest] > 0.3)) flattest = i;
    if (i > flattest && slopes[i] >= kSlopeAtAcromion) {
      const double share = (kSlopeAtAcromion - slopes[i - 1]) / (slopes[i] - slopes[i - 1]);
      return distances[i - 1] + share * (distances[i] - distances[i - 1]);
    }
  }
  return -1;
}

}  // namespace

Shoulders find_shoulders(const BodyShape& body, const Trunk& trunk, const Neck& neck) {
  Shoulders shoulders;
  const double s = body.stature, bottom = trunk.axilla_height() + 0.01 * s;
  const double top = neck.found ? neck.origin.z() : 0.86 * s;
  const std::vector<Outline> chest = trunk.outline_at(trunk.axilla_height() - 0.02 * s);
  if (chest.empty()) return shoulders;
  const double middle = neck.found ? neck.origin.y() : chest.front().centroid.y();

  double sum = 0, weight = 0;
  std::vector<int> skins[2];
  for (Side side : {kLeft, kRight}) {
    const double near = middle + kSign[side] * 0.03 * s, far = middle + kSign[side] * (kFurthest + 0.02) * s;
    skins[side] = triangles_in_box(body, {-s, std::min(near, far), bottom}, {s, std::max(near, far), top});
    std::vector<double> distances, heights;
    for (double d = 0.05 * s; d < kFurthest * s; d += kApart) {
      Vector3d ridge;
      if (!ridge_at(body, skins[side], middle + kSign[side] * d, ridge)) continue;
      distances.push_back(d);
      heights.push_back(ridge.z());
    }
    const double turn = turning_down(distances, heights);
    if (turn > kNearest * s && !trunk.axilla(side).raised) {  // a raised arm goes on where the shoulder ends
      sum += turn;
      ++weight;
    }
    if (trunk.axilla(side).found) {
      const double beyond =
          trunk.axilla(side).raised ? 0 : kBeyondAxilla * s;  // the armpit's skin goes along
      sum += std::abs(trunk.axilla(side).point.y() - middle) + beyond;
      ++weight;
    }
  }
  if (weight == 0) return shoulders;
  const double half_breadth = sum / weight;
  shoulders.found = true;
  for (Side side : {kLeft, kRight}) {
    const double y = middle + kSign[side] * half_breadth;
    Vector3d ridge;
    if (!ridge_at(body, skins[side], y, ridge)) return Shoulders();
    const double behind_ridge = ridge.x() - kBehindRidge * s;
    const double x = neck.found ? (behind_ridge + neck.origin.x() - kBehindNeck * s) / 2 : behind_ridge;
    Vector3d& point = shoulders.points[side];
    point = ridge;
    double nearest = 1e9;
    for (const geometry::SectionLoop& loop : cut(body, skins[side], {0, y, 0}, Vector3d::UnitY())) {
      for (const Vector3d& p : loop.points) {
        const double off =
            std::abs(p.x() - x) + 0.2 * (ridge.z() - p.z());  // on top, not on the arm's underside
        if (off >= nearest) continue;
        nearest = off;
        point = p;
      }
    }
  }
  return shoulders;
}

}  // namespace tensegric_fit::landmarks
