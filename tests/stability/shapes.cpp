#include "shapes.hpp"

#include <cmath>

namespace tensegric_fit::stability {

using Eigen::Vector3d;

geometry::ControlMesh control_of(const geometry::TriangleMesh& mesh, double thickness) {
  geometry::ControlMesh control;
  control.outer = mesh.vertices;
  control.triangles = mesh.triangles;
  const auto normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    control.inner.push_back(mesh.vertices[i] - thickness * normals[i]);
  control.outer_fixed.assign(mesh.vertices.size(), 0);
  control.inner_fixed.assign(mesh.vertices.size(), 0);
  control.names.resize(mesh.vertices.size());
  control.regions.push_back({"shape", {}});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    control.regions[0].triangles.push_back(static_cast<int>(t));
  return control;
}

geometry::ControlMesh sheet(int columns, int rows, const std::function<Vector3d(Vector3d)>& shape) {
  geometry::TriangleMesh mesh;
  const auto index = [columns](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.vertices.push_back(shape(0.02 * Vector3d(i, j, 0)));
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
    }
  }
  geometry::ControlMesh control = control_of(mesh, 0.01);
  hold(control, [=](int node) {
    const int i = node % (columns + 1), j = node / (columns + 1);
    return i == 0 || j == 0 || i == columns || j == rows;
  });
  return control;
}

geometry::ControlMesh torus(int around, int across) {
  geometry::TriangleMesh mesh;
  const auto index = [=](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * M_PI * i / around, b = 2 * M_PI * j / across, r = 0.1 + 0.04 * std::cos(b);
      mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), 0.04 * std::sin(b));
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
    }
  }
  geometry::ControlMesh control = control_of(mesh, 0.012);
  hold(control, [&control](int node) { return control.outer[node].x() < -0.08; });
  return control;
}

void hold(geometry::ControlMesh& control, const std::function<bool(int)>& held) {
  for (std::size_t i = 0; i < control.outer.size(); ++i)
    control.outer_fixed[i] = control.inner_fixed[i] = held(static_cast<int>(i));
}

tensegric::Garment line_over(geometry::ControlMesh& control, const std::vector<int>& nodes, double ratio) {
  tensegric::Garment garment;
  garment.name = "band";
  tensegric::GarmentLine line;
  line.name = "line";
  line.ratio = ratio;
  line.taut = true;  // from node to node as given
  for (int node : nodes) {
    if (control.names[node].empty()) control.names[node] = "node_" + std::to_string(node);
    line.through.push_back(control.names[node]);
  }
  garment.lines.push_back(line);
  return garment;
}

tensegric::Garment chest(double ratio) {
  tensegric::Garment garment;
  garment.name = "B1";
  garment.regions = {"bust"};
  garment.lines.emplace_back();
  garment.lines[0].name = "chest";
  garment.lines[0].ratio = ratio;
  garment.lines[0].through = {"axilla_L", "bust_point_L", "sternum", "bust_point_R", "axilla_R"};
  return garment;
}

}  // namespace tensegric_fit::stability
