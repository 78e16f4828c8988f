/// Closed meshes of shapes that are given by a function of space.
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

}  // namespace tensegric_fit::test
