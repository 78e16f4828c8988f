#include "landmarks/lower_trunk.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/profile.hpp"
#include "landmarks/surface_point.hpp"

namespace tensegric_fit::landmarks {
namespace {

// Statures: the perineum's middle, on bone, however far back thighs touch; and of what thighs are deeper than
// slim ones, this share lies as fat before the bone.
constexpr double kBehindPubis = 0.044, kSlimThigh = 0.092, kFatBefore = 0.08;
constexpr double kThighBelowCrotch = 0.03;

// Statures over the crotch: buttocks stand out 0.048 to 0.062 up, rolls of the back from 0.10 on.
constexpr double kLowestSeat = -0.02, kHighestSeat = 0.09;

constexpr double kThigh = 0.13;  // statures under the buttock point: the back of the thigh, below the fold
constexpr double kFoldByProportion = 0.065;
constexpr double kFoldDepth = 0.003;  // m under the straight edge; less is no fold

constexpr double kFlatSide = 0.003;  // m

}  // namespace

bool find_buttock(const BodyShape& body, Side side, Eigen::Vector3d& point) {
  const double s = body.stature, crotch = body.crotch.height;
  const double near = kSign[side] * 0.01 * s,
               far = kSign[side] * 0.10 * s;  // beside the cleft, within the hips
  const Level& level = body.levels.levels[body.levels.nearest(crotch + 0.05 * s)];
  if (level.trunk < 0) return false;
  const Eigen::Vector2d& middle = level.outlines[level.trunk].centroid;
  const std::vector<int> seat =
      vertices_in_box(body, {middle.x() - s, middle.y() + std::min(near, far), crotch + kLowestSeat * s},
                      {middle.x(), middle.y() + std::max(near, far), crotch + kHighestSeat * s});
  if (seat.empty()) return false;
  const Eigen::Vector3d back = -Eigen::Vector3d::UnitX();
  // 35 mm of skin: wide enough that half a millimetre of noise moves the apex by a millimetre only.
  point = apex_of_bulge(body, body.mesh.vertices[furthest_vertex(body, seat, back)], back, 0.021 * s);
  return true;
}

GlutealFold find_gluteal_fold(const BodyShape& body, const Eigen::Vector3d& buttock) {
  const double s = body.stature, beside = 0.01;
  const std::vector<int> skin = triangles_in_box(
      body, {buttock.x() - 0.02 * s, buttock.y() - beside, buttock.z() - (kThigh + 0.03) * s},
      {buttock.x() + 0.09 * s, buttock.y() + beside, buttock.z()});
  const Profile profile = cut_profile(body, skin, buttock, -Eigen::Vector3d::UnitX());
  const Eigen::Vector3d* deepest = nullptr;
  const Eigen::Vector3d* by_proportion = nullptr;
  if (!profile.points.empty() && profile.points.back().z() < buttock.z() - kThigh * s) {
    const Eigen::Vector3d edge = (profile.points.back() - buttock).normalized();
    const Eigen::Vector3d inwards = profile.sideways.cross(edge);
    double depth = kFoldDepth;
    for (const Eigen::Vector3d& p : profile.points) {
      if (by_proportion == nullptr && p.z() < buttock.z() - kFoldByProportion * s) by_proportion = &p;
      if (inwards.dot(p - buttock) <= depth) continue;
      depth = inwards.dot(p - buttock);
      deepest = &p;
    }
  }
  if (deepest != nullptr) return {*deepest, 0.8, ""};
  return {
      by_proportion != nullptr ? *by_proportion : buttock - kFoldByProportion * s * Eigen::Vector3d::UnitZ(),
      0.3, "no fold under the buttock; a level by proportion"};
}

Eigen::Vector3d side_of(const Outline& outline, Side side) {
  double farthest = -1e9, x_sum = 0;
  for (const Eigen::Vector3d& p : outline.points) farthest = std::max(farthest, kSign[side] * p.y());
  int count = 0;
  for (const Eigen::Vector3d& p : outline.points) {
    if (kSign[side] * p.y() < farthest - kFlatSide) continue;
    x_sum += p.x();
    ++count;
  }
  const double x = x_sum / count;
  const Eigen::Vector3d* best = &outline.points.front();
  const auto off_middle = [&](const Eigen::Vector3d& p) {
    return kSign[side] * p.y() < farthest - kFlatSide ? 1e9 : std::abs(p.x() - x);
  };
  for (const Eigen::Vector3d& p : outline.points)
    if (off_middle(p) < off_middle(*best)) best = &p;
  return *best;
}

Eigen::Vector3d find_crotch(const BodyShape& body) {
  const double y = body.crotch.above.y, s = body.stature;
  const Bridge bridge = narrowest_bridge(body.sliced.outlines_at(body.crotch.height + 0.008 * s), y, y);
  const Level& thighs = body.levels.levels[body.levels.nearest(
      std::min(body.crotch.height - kThighBelowCrotch * s, body.levels.legs_part))];
  double depth = 0;
  for (const int leg : thighs.legs)
    if (leg >= 0) depth += (thighs.outlines[leg].high.x() - thighs.outlines[leg].low.x()) / (2 * s);
  const double behind = kBehindPubis + kFatBefore * std::max(depth - kSlimThigh, 0.0);
  return {std::max(bridge.front - behind * s, bridge.back), y, body.crotch.height};
}

}  // namespace tensegric_fit::landmarks
