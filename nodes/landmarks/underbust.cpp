#include <algorithm>
#include <cmath>

#include "landmarks/bust.hpp"
#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kMedialReach = 0.055;  // metres, from the definition of the underbust level
constexpr double kApart = 0.005;        // between two profiles
constexpr int kReach = 8;               // millimetres each way over which a profile's hollowness is taken
constexpr double kBelow = 0.13;  // statures under the bust point: where the fold of a hanging breast still is
constexpr double kHollow = 15;   // 1/m: a radius of 70 mm is a rib cage's roundness, not a fold

struct Hollow {
  Vector3d point;
  double hollowness = 0;
};

// Most hollow point of the profile at lateral position y, below the bust point.
Hollow most_hollow(const BodyShape& body, const std::vector<int>& skin, const Vector3d& bust_point,
                   double y) {
  const Profile profile = cut_profile(body, skin, {bust_point.x(), y, bust_point.z()}, Vector3d::UnitX());
  Hollow best;
  for (int i = 0; i < static_cast<int>(profile.points.size()); ++i) {
    if (profile.points[i].z() > bust_point.z() - 0.012) continue;  // the nipple's own rim is hollow too
    const double hollowness = profile.hollowness(i, kReach);
    if (hollowness > best.hollowness) best = {profile.points[i], hollowness};
  }
  return best;
}

}  // namespace

Fold find_fold(const BodyShape& body, const Vector3d& bust_point, Side side) {
  const double s = body.stature, inwards = -kSign[side];
  const double medial = bust_point.y() + inwards * (kMedialReach + 0.01),
               lateral = bust_point.y() - inwards * 0.01;
  const std::vector<int> skin = triangles_in_box(
      body, {bust_point.x() - 0.12 * s, std::min(medial, lateral), bust_point.z() - kBelow * s},
      {bust_point.x() + 0.03 * s, std::max(medial, lateral), bust_point.z() + 0.01 * s});
  Fold fold;
  const Hollow first = most_hollow(body, skin, bust_point, bust_point.y());
  if (first.hollowness < kHollow) {
    const Vector3d guess = bust_point - 0.035 * s * Vector3d::UnitZ();
    return {guess, guess, 0.2, "no fold under the breast"};
  }
  fold.below_bust_point = fold.lowest = first.point;
  Vector3d last = first.point;
  for (int k = 1; k * kApart <= kMedialReach + 1e-9; ++k) {
    const Hollow next = most_hollow(body, skin, bust_point, bust_point.y() + inwards * k * kApart);
    // The fold runs on smoothly; where it ends, at the sternum, the profile's hollow is elsewhere.
    if (next.hollowness < kHollow || std::abs(next.point.z() - last.z()) > 2 * kApart) break;
    if (next.point.z() < fold.lowest.z()) fold.lowest = next.point;
    last = next.point;
  }
  fold.confidence = 0.9;
  return fold;
}

}  // namespace tensegric_fit::landmarks
