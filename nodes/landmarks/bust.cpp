#include <algorithm>
#include <cmath>
#include <optional>

#include "landmarks/bust.hpp"
#include "landmarks/nipple.hpp"
#include "landmarks/surface_point.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// Search window, in statures. From breasts that sit high to ones that hang to the elbow; beside the sternum,
// within the arms.
constexpr double kLowest = -0.17, kHighest = 0.03;  // from the axilla
constexpr double kMedial = 0.025, kLateral = 0.13;
constexpr double kNeighbourhood = 0.015;  // a tip is the skin furthest along its breast within 25 mm
constexpr double kApex = 0.027;           // 45 mm of skin tell it where no nipple does
constexpr double kCleavage = 0.005, kAboveTip = 0.015;  // 8 mm behind the tips, and over a round belly's top
constexpr double kProfileReach =
    0.045;  // about a breast's radius: skin above and below that it stands out from

// Breasts do not point straight forward: on each side the skin round the tip looks outwards by 25 degrees,
// and a little up, whether it is firm or soft.
Vector3d pointing(Side side) {
  const double out = 25 * 3.14159265358979323846 / 180, up = 7 * 3.14159265358979323846 / 180;
  return {std::cos(up) * std::cos(out), kSign[side] * std::cos(up) * std::sin(out), std::sin(up)};
}

// Furthest forward that the chest's skin reaches near (y, z), or nothing_there.
double front_at(const BodyShape& body, const std::vector<int>& chest, double y, double z,
                double nothing_there) {
  double front = -1e9;
  for (int v : chest) {
    const Vector3d& p = body.mesh.vertices[v];
    if (std::hypot(p.y() - y, p.z() - z) < 0.006 * body.stature) front = std::max(front, p.x());
  }
  return front < -1e8 ? nothing_there : front;
}

}  // namespace

BustPoint find_bust_point(const BodyShape& body, const Trunk& trunk, Side side) {
  const double s = body.stature, axilla = trunk.axilla_height();
  const std::vector<Outline> section = trunk.outline_at(axilla - 0.05 * s);
  const Eigen::Vector2d middle = section.empty() ? Eigen::Vector2d(0, 0) : section.front().centroid;
  const double sign = kSign[side];
  const Vector3d ahead = pointing(side);
  const double near = middle.y() + sign * kMedial * s, far = middle.y() + sign * kLateral * s;
  const double margin = kProfileReach * s;
  const std::vector<int> chest = vertices_in_box(
      body,
      {middle.x(), std::min({near, far, middle.y()}) - kNeighbourhood * s, axilla + kLowest * s - margin},
      {middle.x() + s, std::max({near, far, middle.y()}) + kNeighbourhood * s,
       axilla + kHighest * s + margin});

  // A belly stands out too, most of all in its middle, where between breasts the chest recedes.
  int best = -1;
  double most = 0.004 * s;  // 7 mm: less is the rib cage's own roundness
  for (int v : chest) {
    const Vector3d& p = body.mesh.vertices[v];
    if (p.z() < axilla + kLowest * s || p.z() > axilla + kHighest * s || (p.y() - near) * (p.y() - far) > 0)
      continue;
    const bool furthest = std::none_of(chest.begin(), chest.end(), [&](int w) {
      const Vector3d& q = body.mesh.vertices[w];
      return ahead.dot(q - p) > 0 && (q - p).squaredNorm() < std::pow(kNeighbourhood * s, 2);
    });
    if (!furthest ||
        front_at(body, chest, middle.y(), p.z() + kAboveTip * s, p.x() - 1) > p.x() - kCleavage * s)
      continue;
    const double above = front_at(body, chest, p.y(), p.z() + margin, p.x());
    const double below = front_at(body, chest, p.y(), p.z() - margin, p.x());
    const double stands_out = p.x() - (above + below) / 2;
    if (stands_out <= most) continue;
    most = stands_out;
    best = v;
  }
  if (best >= 0) {
    const Vector3d apex = apex_of_bulge(body, body.mesh.vertices[best], ahead, kApex * s);
    if (const std::optional<Vector3d> nipple = find_nipple(body, apex)) return {*nipple, 0.9, ""};
    return {apex, 0.7, ""};
  }

  // A flat chest: the foremost point of the half chest under the axilla.
  BustPoint flat{{middle.x(), near, axilla - 0.03 * s}, 0.3, "no breast stands out from the chest"};
  std::vector<int> half;
  for (int v : chest) {
    const Vector3d& p = body.mesh.vertices[v];
    if (p.z() > axilla - 0.08 * s && p.z() < axilla && (p.y() - near) * (p.y() - far) <= 0) half.push_back(v);
  }
  if (!half.empty()) flat.point = body.mesh.vertices[furthest_vertex(body, half, Vector3d::UnitX())];
  return flat;
}

}  // namespace tensegric_fit::landmarks
