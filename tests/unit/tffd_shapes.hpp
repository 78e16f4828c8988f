/// Shapes for the tests of t-FFD: a slab of skin with a bump, and control meshes over it.
#pragma once

#include <cmath>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::tffd {

/// A breast-like bump, 60 mm high, mirror-symmetric in x.
inline double bump(double x, double y) {
  return 0.06 * std::exp(-(x * x + y * y) / (2 * 0.05 * 0.05));
}

/// Triangles of a grid of rows x columns vertices, facing up where columns run along x and rows along y. Its
/// diagonals are mirrored in the middle column.
inline void add_grid(int rows, int columns, int first, bool up, std::vector<Eigen::Vector3i>& triangles) {
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = first + r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      std::vector<Eigen::Vector3i> pair{{a, b, d}, {b, e, d}};
      if (2 * c + 2 > columns - 1) pair = {{a, b, e}, {a, e, d}};
      for (Eigen::Vector3i t : pair) {
        if (!up) std::swap(t[1], t[2]);
        triangles.push_back(t);
      }
    }
}

/// Skin of 0.3 m x 0.3 m with the bump, `count` vertices a side; then its back, 30 mm below, facing down;
/// then the underside of an arm 90 mm above, facing down.
inline geometry::TriangleMesh slab(int count) {
  geometry::TriangleMesh body;
  for (const int sheet : {0, 1, 2}) {
    for (int r = 0; r < count; ++r)
      for (int c = 0; c < count; ++c) {
        const double x = 0.3 * (c - (count - 1) / 2.0) / (count - 1),
                     y = 0.3 * (r - (count - 1) / 2.0) / (count - 1);
        body.vertices.emplace_back(x, y, sheet == 0 ? bump(x, y) : sheet == 1 ? -0.03 : 0.09);
      }
    add_grid(count, count, sheet * count * count, sheet == 0, body.triangles);
  }
  return body;
}

/// Over the middle 0.2 m x 0.16 m of the slab: 9 x 7 nodes, 96 triangles, 25 mm thick, its rim fixed.
inline geometry::ControlMesh patch() {
  geometry::ControlMesh control;
  constexpr int kRows = 7, kColumns = 9;
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double x = 0.025 * (c - 4), y = 0.16 * (r - 3) / 6;
      control.outer.emplace_back(x, y, bump(x, y));
      const char fixed = r == 0 || r == kRows - 1 || c == 0 || c == kColumns - 1;
      control.outer_fixed.push_back(fixed);
      control.inner_fixed.push_back(fixed);
    }
  add_grid(kRows, kColumns, 0, true, control.triangles);
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(control.outer, control.triangles);
  for (std::size_t i = 0; i < control.outer.size(); ++i)
    control.inner.push_back(control.outer[i] - 0.025 * normals[i]);
  control.names.resize(control.outer.size());
  return control;
}

/// A sphere of `bands` bands from pole to pole and twice as many sectors, closed, outward.
inline geometry::TriangleMesh sphere(double radius, int bands) {
  geometry::TriangleMesh mesh;
  const int sectors = 2 * bands;
  mesh.vertices.emplace_back(0, 0, radius);
  for (int b = 1; b < bands; ++b)
    for (int s = 0; s < sectors; ++s) {
      const double polar = M_PI * b / bands, around = 2 * M_PI * s / sectors;
      mesh.vertices.push_back(radius * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                       std::sin(polar) * std::sin(around), std::cos(polar)));
    }
  mesh.vertices.emplace_back(0, 0, -radius);
  const auto at = [&](int band, int sector) { return 1 + (band - 1) * sectors + sector % sectors; };
  for (int s = 0; s < sectors; ++s) {
    mesh.triangles.emplace_back(0, at(1, s), at(1, s + 1));
    for (int b = 1; b + 1 < bands; ++b) {
      mesh.triangles.emplace_back(at(b, s), at(b + 1, s), at(b + 1, s + 1));
      mesh.triangles.emplace_back(at(b, s), at(b + 1, s + 1), at(b, s + 1));
    }
    mesh.triangles.emplace_back(at(bands - 1, s), static_cast<int>(mesh.vertices.size()) - 1,
                                at(bands - 1, s + 1));
  }
  return mesh;
}

/// A closed control mesh without fixed nodes: a sphere of 0.1 m with its inner nodes at 0.08 m.
inline geometry::ControlMesh ball() {
  const geometry::TriangleMesh shell = sphere(0.1, 6);
  geometry::ControlMesh control;
  control.outer = shell.vertices;
  control.triangles = shell.triangles;
  for (const Eigen::Vector3d& p : control.outer) control.inner.push_back(0.8 * p);
  control.outer_fixed.assign(control.outer.size(), 0);
  control.inner_fixed = control.outer_fixed;
  control.names.resize(control.outer.size());
  return control;
}

/// Nodes moved as a chest band would: squeezed towards x = 0 and pushed up, most at the top; fixed ones stay.
struct Moved {
  std::vector<Eigen::Vector3d> outer, inner;
};
inline Moved squeezed(const geometry::ControlMesh& control, double amplitude) {
  const auto motion = [amplitude](const Eigen::Vector3d& p) {
    const double most = amplitude * std::exp(-(p.x() * p.x() + p.y() * p.y()) / (2 * 0.04 * 0.04));
    return Eigen::Vector3d(-most * p.x() / 0.05, 0.6 * most, -0.5 * most);
  };
  Moved moved{control.outer, control.inner};
  for (std::size_t i = 0; i < control.outer.size(); ++i) {
    if (!control.outer_fixed[i]) moved.outer[i] += motion(control.outer[i]);
    if (!control.inner_fixed[i]) moved.inner[i] += 0.5 * motion(control.outer[i]);
  }
  return moved;
}

}  // namespace tensegric_fit::tffd
