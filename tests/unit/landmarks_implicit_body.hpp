/// A person of simple shapes melted together, as a closed mesh, for the tests of the landmarks.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::test {

using Distance = std::function<double(const Eigen::Vector3d&)>;  // negative inside

inline double capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ra,
                      double rb) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - ((1 - t) * ra + t * rb);
}

inline double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& centre,
                        const Eigen::Vector3d& radii) {
  const double scaled = (p - centre).cwiseQuotient(radii).norm();
  return (scaled - 1) * radii.minCoeff();
}

/// Minimum with edges rounded over 20 mm.
inline double melt(double a, double b) {
  const double k = 0.02, h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

/// Metres: of breasts that hang.
inline constexpr double kHangingFold = 1.175;
/// Metres: where hanging arm and trunk part, 0.16 m to the side.
inline constexpr double kArmpit = 1.29;

struct Parts {
  bool head = true, arms = true, right_arm = true;
  bool arms_out = false;         ///< to the sides, a little under level
  double hands_higher = 0;       ///< metres, of such arms
  double hands_back = 0;         ///< metres by which the arms run backwards to the hands
  double web_in_armpits = 0;     ///< metres of a thin skin down from where arm and trunk meet
  double left_breast_lower = 0;  ///< metres
  double web_below_crotch = 0;   ///< metres of a thin skin between the thighs, as a scan's hole filling makes
  bool hand_beside_thigh = false;  ///< a left hand 0.1 m away from the thigh
  bool breasts_hang = false;       ///< 60 mm below the fold, clear of the chest
  double web_below_fold = 0;       ///< metres of a thin skin from such a breast to the chest
  double head_forward = 0;         ///< metres by which the head is held forward
  double belly = 0;                ///< metres by which a round belly reaches further forward than the breasts
};

/// x forward, y left, z up, soles at 0. The breasts' foremost points are (0.155, +-0.085, 1.24), least girth
/// of the trunk near 1.08.
inline double person(const Eigen::Vector3d& p, const Parts& parts) {
  double d = ellipsoid(p, {0, 0, 0.93}, {0.11, 0.16, 0.14});
  d = melt(d, ellipsoid(p, {0, 0, 1.08}, {0.095, 0.12, 0.20}));
  if (parts.belly > 0) d = melt(d, ellipsoid(p, {0, 0, 1.04}, {0.155 + parts.belly, 0.17, 0.14}));
  d = melt(d, ellipsoid(p, {0, 0, 1.26}, {0.11, 0.15, 0.17}));
  for (double side : {1.0, -1.0}) {
    const double lower = side > 0 ? parts.left_breast_lower : 0;
    d = melt(d, capsule(p, {0, side * 0.10, 0.05}, {0, side * 0.09, 0.80}, 0.045, 0.08));
    d = melt(d, capsule(p, {-0.03, side * 0.10, 0.04}, {0.14, side * 0.11, 0.03}, 0.04, 0.03));
    d = melt(d, ellipsoid(p, {-0.05, side * 0.07, 0.90}, {0.09, 0.08, 0.09}));
    d = melt(d, ellipsoid(p, {0.09, side * 0.085, 1.24 - lower}, {0.065, 0.06, 0.06}));
    if (parts.breasts_hang) d = melt(d, ellipsoid(p, {0.135, side * 0.085, 1.19}, {0.040, 0.050, 0.085}));
    if (parts.web_below_fold > 0) {
      const Eigen::Vector3d q = (p - Eigen::Vector3d(0.10, side * 0.085, kHangingFold)).cwiseAbs();
      d = std::min(d, std::max({q.x() - 0.04, q.y() - 0.010, q.z() - parts.web_below_fold}));
    }
    d = melt(d, capsule(p, {0, side * 0.05, 1.40}, {0, side * 0.17, 1.36}, 0.05, 0.05));
    const double hand_y = parts.arms_out ? 0.70 : 0.42,
                 hand_z = parts.arms_out ? 1.26 + parts.hands_higher : 0.80;
    if (parts.arms && (side > 0 || parts.right_arm))
      d = melt(d,
               capsule(p, {0, side * 0.19, 1.34}, {-parts.hands_back, side * hand_y, hand_z}, 0.045, 0.03));
    if (parts.web_in_armpits > 0) {
      const Eigen::Vector3d q = (p - Eigen::Vector3d(0, side * 0.17, kArmpit)).cwiseAbs();
      d = std::min(d, std::max({q.x() - 0.010, q.y() - 0.04, q.z() - parts.web_in_armpits}));
    }
  }
  const double ahead = parts.head_forward;
  d = melt(d, capsule(p, {0, 0, 1.38}, {0.02 + ahead, 0, 1.50}, 0.055, 0.05));
  if (parts.head) d = melt(d, ellipsoid(p, {0.03 + ahead, 0, 1.58}, {0.10, 0.08, 0.12}));
  if (parts.hand_beside_thigh) d = std::min(d, capsule(p, {0, 0.27, 0.80}, {0, 0.27, 0.62}, 0.03, 0.03));
  if (parts.web_below_crotch > 0) {
    const Eigen::Vector3d q = (p - Eigen::Vector3d(0, 0, 0.76)).cwiseAbs();
    d = std::min(d, std::max({q.x() - 0.015, q.y() - 0.05, q.z() - parts.web_below_crotch}));
  }
  return d;
}

/// Surface of `distance` = 0 in a box by marching tetrahedra: closed and oriented outward where the box holds
/// all of it.
inline geometry::TriangleMesh surface_of(const Distance& distance, const Eigen::Vector3d& low,
                                         const Eigen::Vector3d& high, double spacing) {
  const Eigen::Vector3i n = ((high - low) / spacing).array().ceil().cast<int>() + 1;
  const auto index = [&](int i, int j, int k) { return i + n.x() * (j + n.y() * k); };
  const auto at = [&](int v) {
    return Eigen::Vector3d(low + spacing * Eigen::Vector3d(v % n.x(), v / n.x() % n.y(), v / n.x() / n.y()));
  };
  std::vector<double> values(static_cast<std::size_t>(n.prod()));
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = distance(at(static_cast<int>(v)));

  geometry::TriangleMesh mesh;
  std::map<std::pair<int, int>, int> on_edge;
  const auto vertex = [&](int a, int b) {
    const auto found = on_edge.emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
    if (found.second) {  // kept off the ends, so that no triangle collapses
      const int first = std::min(a, b), second = std::max(a, b);
      const double t = std::clamp(values[first] / (values[first] - values[second]), 0.02, 0.98);
      mesh.vertices.push_back((1 - t) * at(first) + t * at(second));
    }
    return found.first->second;
  };
  // `inside` are the tetrahedron's corners within the body, in an order that leaves its hand as it was.
  const auto cut = [&](const std::array<int, 4>& t) {
    std::array<int, 4> order = t;
    int inside = 0, swaps = 0;
    for (int k = 0; k < 4; ++k) {
      if (values[t[k]] >= 0) continue;
      for (int m = k; m > inside; --m, ++swaps) std::swap(order[m], order[m - 1]);
      ++inside;
    }
    std::vector<Eigen::Vector3i> faces;
    const auto [a, b, c, d] = order;
    if (inside == 1) faces = {{vertex(a, b), vertex(a, c), vertex(a, d)}};
    if (inside == 3) faces = {{vertex(d, a), vertex(d, b), vertex(d, c)}};
    if (inside == 2) {
      const int ac = vertex(a, c), ad = vertex(a, d), bc = vertex(b, c), bd = vertex(b, d);
      faces = {{ac, ad, bd}, {ac, bd, bc}};
    }
    for (Eigen::Vector3i& face : faces) {
      if (swaps % 2 == 1) std::swap(face[1], face[2]);
      mesh.triangles.push_back(face);
    }
  };
  // Six tetrahedra a cube, one for each way along its edges from the low corner to the high one.
  constexpr std::array<std::array<int, 3>, 6> ways{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
  for (int k = 0; k + 1 < n.z(); ++k) {
    for (int j = 0; j + 1 < n.y(); ++j) {
      for (int i = 0; i + 1 < n.x(); ++i) {
        for (std::size_t w = 0; w < ways.size(); ++w) {
          Eigen::Vector3i corner(i, j, k);
          std::array<int, 4> t{index(i, j, k), 0, 0, 0};
          for (int step = 0; step < 3; ++step) {
            ++corner[ways[w][step]];
            t[step + 1] = index(corner.x(), corner.y(), corner.z());
          }
          if (w >= 3) std::swap(t[2], t[3]);  // the odd ways are left-handed
          cut(t);
        }
      }
    }
  }
  return mesh;
}

inline geometry::TriangleMesh person_mesh(const Parts& parts = {}) {
  const double reach = parts.arms_out ? 0.76 : 0.5;
  return surface_of([&](const Eigen::Vector3d& p) { return person(p, parts); }, {-0.2, -reach, -0.02},
                    {0.26, reach, 1.74}, 0.012);
}

}  // namespace tensegric_fit::test
