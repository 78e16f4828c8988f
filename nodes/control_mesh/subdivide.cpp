#include "control_mesh/subdivide.hpp"

#include <map>

namespace tensegric_fit::control_mesh {

using Eigen::Vector3d;

geometry::ControlMesh subdivide(const geometry::ControlMesh& control, const Skin& skin) {
  geometry::ControlMesh fine = control;
  fine.triangles.clear();
  const auto normals = geometry::vertex_normals(control.outer, control.triangles);
  const auto edges = geometry::edges_of({control.outer, control.triangles});
  std::vector<char> on_rim(control.outer.size(), 0);
  for (const geometry::Edge& edge : edges)
    if (edge.right < 0) on_rim[edge.first] = on_rim[edge.second] = 1;
  std::map<std::pair<int, int>, int> middle_of;
  for (const geometry::Edge& edge : edges) {
    const int a = edge.first, b = edge.second;
    middle_of[{a, b}] = static_cast<int>(fine.outer.size());
    const Vector3d middle = 0.5 * (control.outer[a] + control.outer[b]);
    const Vector3d normal = (normals[a] + normals[b]).normalized();
    const auto above = skin.nearest_along(middle, normal, 0.5 * (control.outer[b] - control.outer[a]).norm());
    fine.outer.push_back(above ? *above : skin.nearest(middle));
    fine.inner.push_back(0.5 * (control.inner[a] + control.inner[b]));
    const bool across = edge.right >= 0 && on_rim[a] && on_rim[b];  // from rim to rim over free skin
    fine.outer_fixed.push_back(!across && control.outer_fixed[a] && control.outer_fixed[b]);
    fine.inner_fixed.push_back(!across && control.inner_fixed[a] && control.inner_fixed[b]);
    fine.names.emplace_back();
  }

  const auto middle = [&middle_of](int a, int b) { return middle_of.at({std::min(a, b), std::max(a, b)}); };
  for (const Eigen::Vector3i& k : control.triangles) {
    const int ab = middle(k[0], k[1]), bc = middle(k[1], k[2]), ca = middle(k[2], k[0]);
    fine.triangles.emplace_back(k[0], ab, ca);
    fine.triangles.emplace_back(ab, k[1], bc);
    fine.triangles.emplace_back(ca, bc, k[2]);
    fine.triangles.emplace_back(ab, bc, ca);
  }
  for (geometry::ControlRegion& region : fine.regions) {
    std::vector<int> quarters;
    for (int t : region.triangles)
      for (int i = 0; i < 4; ++i) quarters.push_back(4 * t + i);
    region.triangles = std::move(quarters);
  }
  for (geometry::ControlLine& line : fine.lines) {
    std::vector<int> nodes{line.nodes.front()};
    for (std::size_t i = 1; i < line.nodes.size(); ++i) {
      nodes.push_back(middle(line.nodes[i - 1], line.nodes[i]));
      nodes.push_back(line.nodes[i]);
    }
    line.nodes = std::move(nodes);
  }
  return fine;
}

}  // namespace tensegric_fit::control_mesh
