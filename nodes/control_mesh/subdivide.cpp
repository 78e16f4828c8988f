#include "control_mesh/subdivide.hpp"

#include <map>

#include "control_mesh/pull_back.hpp"
#include "control_mesh/relax.hpp"

namespace tensegric_fit::control_mesh {

namespace {

using Eigen::Vector3d;
constexpr double kLeastQuarter = 0.5;  // of a quarter of its triangle, as that one's normal sees it
constexpr int kHalvings = 5;

/// The middles of a triangle's edges: opposite to its first corner, its second, its third.
using Middles = Eigen::Vector3i;

/// In a fold the skin over an edge's middle may be that of the other side, or far along: quarters must be as
/// well shaped as their triangle.
void mark_turned(const std::vector<Eigen::Vector3i>& triangles, const std::vector<Middles>& middles,
                 const std::vector<Vector3d>& nodes, std::vector<char>& turned) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Eigen::Vector3i &k = triangles[t], &m = middles[t];
    const Vector3d whole = geometry::area_vector(nodes[k[0]], nodes[k[1]], nodes[k[2]]);
    const auto well = [&](int a, int b, int c) {
      return geometry::area_vector(nodes[a], nodes[b], nodes[c]).dot(whole) >=
             kLeastQuarter / 4 * whole.squaredNorm();
    };
    if (well(k[0], m[2], m[1]) && well(m[2], k[1], m[0]) && well(m[1], m[0], k[2]) && well(m[2], m[0], m[1]))
      continue;
    for (int i = 0; i < 3; ++i) turned[m[i]] = 1;
  }
}

}  // namespace

geometry::ControlMesh subdivide(const geometry::ControlMesh& control, const Skin& skin) {
  geometry::ControlMesh fine = control;
  fine.triangles.clear();
  const auto normals = geometry::vertex_normals(control.outer, control.triangles);
  const auto edges = geometry::edges_of({control.outer, control.triangles});
  std::vector<char> on_rim(control.outer.size(), 0);
  for (const geometry::Edge& edge : edges)
    if (edge.right < 0) on_rim[edge.first] = on_rim[edge.second] = 1;
  std::map<std::pair<int, int>, int> middle_of;
  std::vector<Vector3d> flat = control.outer;
  for (const geometry::Edge& edge : edges) {
    const int a = edge.first, b = edge.second;
    middle_of[{a, b}] = static_cast<int>(fine.outer.size());
    const Vector3d middle = 0.5 * (control.outer[a] + control.outer[b]);
    const Vector3d normal = (normals[a] + normals[b]).normalized();
    const auto above = skin.nearest_along(middle, normal, 0.5 * (control.outer[b] - control.outer[a]).norm());
    fine.outer.push_back(above ? *above : skin.nearest(middle));
    flat.push_back(middle);
    fine.inner.push_back(0.5 * (control.inner[a] + control.inner[b]));
    const bool across = edge.right >= 0 && on_rim[a] && on_rim[b];  // from rim to rim over free skin
    fine.outer_fixed.push_back(!across && control.outer_fixed[a] && control.outer_fixed[b]);
    fine.inner_fixed.push_back(!across && control.inner_fixed[a] && control.inner_fixed[b]);
    fine.names.emplace_back();
  }

  const auto middle = [&middle_of](int a, int b) { return middle_of.at({std::min(a, b), std::max(a, b)}); };
  std::vector<Middles> middles;
  for (const Eigen::Vector3i& k : control.triangles)
    middles.emplace_back(middle(k[1], k[2]), middle(k[2], k[0]), middle(k[0], k[1]));
  for (const Eigen::Vector3i& k : control.triangles) {
    const int ab = middle(k[0], k[1]), bc = middle(k[1], k[2]), ca = middle(k[2], k[0]);
    fine.triangles.emplace_back(k[0], ab, ca);
    fine.triangles.emplace_back(ab, k[1], bc);
    fine.triangles.emplace_back(ca, bc, k[2]);
    fine.triangles.emplace_back(ab, bc, ca);
  }
  std::vector<Slide> slides(control.outer.size(), Slide::none);
  std::vector<GridNeighbours> ends(control.outer.size(), {-1, -1, -1, -1});
  for (const geometry::Edge& edge : edges) {
    slides.push_back(edge.right < 0 ? Slide::none : Slide::along_column);
    ends.push_back({edge.first, edge.second, -1, -1});
  }
  turn_back(fine, {slides, ends}, skin, {flat});
  // Once nodes go all the way back each round leaves fewer triangles to repair.
  const int rounds = kHalvings + static_cast<int>(control.triangles.size()) + 1;
  pull_back(fine.outer, flat, kHalvings, rounds,
            [&](std::vector<char>& turned) { mark_turned(control.triangles, middles, fine.outer, turned); });
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
