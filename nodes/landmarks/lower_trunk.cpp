#include "landmarks/lower_trunk.hpp"

#include <algorithm>

#include "landmarks/surface_point.hpp"

namespace tensegric_fit::landmarks {
namespace {

constexpr double kBehindPubis =
    0.65;  // of the way from the pubis to the cleft of the buttocks lies the perineum's middle

}  // namespace

bool find_buttock(const BodyShape& body, Side side, Eigen::Vector3d& point) {
  const double s = body.stature, crotch = body.crotch.height;
  const double near = kSign[side] * 0.01 * s,
               far = kSign[side] * 0.10 * s;  // beside the cleft, within the hips
  const Level& level = body.levels.levels[body.levels.nearest(crotch + 0.05 * s)];
  if (level.trunk < 0) return false;
  const Eigen::Vector2d& middle = level.outlines[level.trunk].centroid;
  const std::vector<int> seat =
      vertices_in_box(body, {middle.x() - s, middle.y() + std::min(near, far), crotch - 0.02 * s},
                      {middle.x(), middle.y() + std::max(near, far), crotch + 0.13 * s});
  if (seat.empty()) return false;
  const Eigen::Vector3d back = -Eigen::Vector3d::UnitX();
  // 35 mm of skin: wide enough that half a millimetre of noise moves the apex by a millimetre only.
  point = apex_of_bulge(body, body.mesh.vertices[furthest_vertex(body, seat, back)], back, 0.021 * s);
  return true;
}

Eigen::Vector3d find_crotch(const BodyShape& body) {
  const double y = body.crotch.above.y, s = body.stature;
  const Bridge bridge = narrowest_bridge(body.sliced.outlines_at(body.crotch.height + 0.003 * s), y, y);
  return {bridge.front + kBehindPubis * (bridge.back - bridge.front), y, body.crotch.height};
}

}  // namespace tensegric_fit::landmarks
