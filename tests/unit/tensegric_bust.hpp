/// A control mesh like a bust for the tests of the tensegric room: exactly mirror-symmetric in x.
#pragma once

#include <cmath>
#include <string>

#include "geometry/control_mesh.hpp"
#include "tensegric/garment.hpp"

namespace tensegric_fit::tensegric {

/// Length of an open line over the nodes at `positions`.
inline double line_length(const std::vector<int>& nodes, const std::vector<Eigen::Vector3d>& positions) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    length += (positions[nodes[i]] - positions[nodes[i - 1]]).norm();
  return length;
}

struct BustShape {
  int columns = 10, rows = 6;  ///< quads; even numbers keep the middle column and row on nodes
  bool rim_inner_fixed = true;
  double lopsided = 0;  ///< m added to the height of the left breast
};

/// Two breasts on an elliptic chest, her left at +x, facing -y, z up. 10 x 6 quads: 77 nodes, 120 triangles.
/// Nodes of the middle row are named as the bust template's, and the line "chest" runs along it between the
/// rims.
inline geometry::ControlMesh bust_mesh(const BustShape& shape = {}) {
  geometry::ControlMesh control;
  const int across = shape.columns, up = shape.rows;
  const auto skin = [&shape](double s, double t) {  // s, t in [-1, 1]
    const double angle = s * 1.25, z = 1.2 + 0.13 * t;
    Eigen::Vector3d p(0.155 * std::sin(angle), -0.11 * std::cos(angle), z);
    for (double side : {-1.0, 1.0}) {
      const double ds = (s - side * 0.4) / 0.36, dt = t / 0.7;
      const double height = 0.055 + (side > 0 ? shape.lopsided : 0);
      const double bump = height * std::exp(-(ds * ds + dt * dt));
      p += bump * Eigen::Vector3d(side * 0.25, -1, 0);
    }
    return p;
  };
  const auto index = [across](int i, int j) { return j * (across + 1) + i; };
  for (int j = 0; j <= up; ++j) {
    for (int i = 0; i <= across; ++i) {
      const double s = static_cast<double>(2 * i - across) / across, t = static_cast<double>(2 * j - up) / up;
      control.outer.push_back(skin(s, t));
      const bool rim = i == 0 || j == 0 || i == across || j == up;
      control.outer_fixed.push_back(rim);
      control.inner_fixed.push_back(rim && shape.rim_inner_fixed);
    }
  }
  // Diagonals are mirrored about the middle column.
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < across; ++i) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      if ((i < across / 2) == (j % 2 == 0)) {
        control.triangles.emplace_back(a, b, c);
        control.triangles.emplace_back(a, c, d);
      } else {
        control.triangles.emplace_back(a, b, d);
        control.triangles.emplace_back(b, c, d);
      }
    }
  }
  const auto normals = geometry::vertex_normals(control.outer, control.triangles);
  for (std::size_t v = 0; v < control.outer.size(); ++v) {
    const double thickness = 0.030 + 0.010 * std::exp(-std::pow((control.outer[v].z() - 1.2) / 0.07, 2));
    control.inner.push_back(control.outer[v] - thickness * normals[v]);
  }
  control.names.resize(control.outer.size());
  const int middle = up / 2;
  const std::pair<double, const char*> named[] = {
      {-1, "axilla_R"}, {-0.4, "bust_point_R"}, {0, "sternum"}, {0.4, "bust_point_L"}, {1, "axilla_L"}};
  for (const auto& [s, name] : named)
    control.names[index(static_cast<int>(std::lround((s + 1) / 2 * across)), middle)] = name;
  geometry::ControlRegion bust{"bust", {}};
  for (std::size_t t = 0; t < control.triangles.size(); ++t) bust.triangles.push_back(static_cast<int>(t));
  control.regions.push_back(bust);
  geometry::ControlLine chest{"chest", {}};
  for (int i = 0; i <= across; ++i) chest.nodes.push_back(index(i, middle));
  control.lines.push_back(chest);
  return control;
}

/// A garment of one line that runs along a line of the control mesh.
inline Garment chest(double ratio, const std::string& name = "chest") {
  Garment garment;
  garment.name = "B1";
  garment.regions = {"bust"};
  garment.lines.emplace_back();
  garment.lines[0].name = name;
  garment.lines[0].ratio = ratio;
  return garment;
}

}  // namespace tensegric_fit::tensegric
