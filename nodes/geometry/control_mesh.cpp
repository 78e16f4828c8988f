#include "geometry/control_mesh.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {

int ControlMesh::node(const std::string& name) const {
  if (name.empty()) return -1;
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

void check_control_mesh(const ControlMesh& control) {
  const std::size_t count = control.outer.size();
  if (count == 0 || control.inner.size() != count || control.outer_fixed.size() != count ||
      control.inner_fixed.size() != count || control.names.size() != count)
    throw Refusal(refusal::kBadMesh, "the control mesh's per-node arrays differ in length");
  const TriangleMesh mesh{control.outer, control.triangles};
  check_mesh(mesh);
  edges_of(mesh);
  std::vector<char> has_triangle(count, 0);
  for (const Eigen::Vector3i& t : control.triangles)
    for (const int v : t) has_triangle[v] = 1;
  if (std::find(has_triangle.begin(), has_triangle.end(), 0) != has_triangle.end())
    throw Refusal(refusal::kBadMesh, "a node of the control mesh belongs to no triangle");
  for (const Eigen::Vector3d& p : control.inner)
    if (!p.allFinite()) throw Refusal(refusal::kNonFinite, "an inner node of the control mesh is not finite");
  if (control.regions.empty()) throw Refusal(refusal::kBadMesh, "the control mesh has no region");
  constexpr std::size_t kMostRegions = 64, kMostLines = 1024;  // each is a picture or a name to be looked for
  if (control.regions.size() > kMostRegions || control.lines.size() > kMostLines)
    throw Refusal(refusal::kBadMesh, "the control mesh has more than 64 regions or 1024 lines");
  const auto check_indices = [](const std::vector<int>& list, std::size_t limit, const std::string& of) {
    for (int i : list)
      if (i < 0 || static_cast<std::size_t>(i) >= limit)
        throw Refusal(refusal::kBadMesh, of + " of the control mesh has an index out of range");
  };
  for (const ControlRegion& region : control.regions) {
    if (region.triangles.empty())
      throw Refusal(refusal::kBadMesh, "region " + region.name + " has no triangles");
    check_indices(region.triangles, control.triangles.size(), "region " + region.name);
  }
  for (const ControlLine& line : control.lines) check_indices(line.nodes, count, "line " + line.name);
}

ControlMesh joined(const std::vector<ControlMesh>& parts) {
  ControlMesh all;
  std::set<std::string> taken;
  const auto take = [&taken](const std::string& kind, const std::string& name) {
    if (!name.empty() && !taken.insert(kind + " " + name).second)
      throw Refusal(refusal::kBadTemplate,
                    "two control meshes for one body both have a " + kind + " '" + name + "'");
  };
  const auto append = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
  for (const ControlMesh& part : parts) {
    const int nodes = static_cast<int>(all.outer.size()), triangles = static_cast<int>(all.triangles.size());
    for (const std::string& name : part.names) take("node", name);
    append(all.outer, part.outer);
    append(all.inner, part.inner);
    append(all.outer_fixed, part.outer_fixed);
    append(all.inner_fixed, part.inner_fixed);
    append(all.names, part.names);
    for (const Eigen::Vector3i& t : part.triangles)
      all.triangles.push_back(t + Eigen::Vector3i::Constant(nodes));
    for (ControlRegion region : part.regions) {
      take("region", region.name);
      for (int& t : region.triangles) t += triangles;
      all.regions.push_back(std::move(region));
    }
    for (ControlLine line : part.lines) {
      take("line", line.name);
      for (int& node : line.nodes) node += nodes;
      all.lines.push_back(std::move(line));
    }
  }
  return all;
}

std::vector<Eigen::Vector3i> region_triangles(const ControlMesh& control, const ControlRegion& region) {
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(region.triangles.size());
  for (int t : region.triangles) triangles.push_back(control.triangles[t]);
  return triangles;
}

Eigen::Vector3d region_apex(const ControlMesh& control, const ControlRegion& region) {
  std::vector<char> used(control.outer.size(), 0);
  for (int t : region.triangles)
    for (int k = 0; k < 3; ++k) used[control.triangles[t][k]] = 1;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    sum += control.outer[v];
    ++count;
  }
  return sum / count;
}

std::vector<int> route_over_edges(const ControlMesh& control, const std::vector<int>& stops,
                                  const std::string& line) {
  const auto neighbours = neighbours_of(control.outer.size(), control.triangles);
  std::vector<int> route;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (i == 0) {
      route.push_back(stops[0]);
      continue;
    }
    // Dijkstra from the far stop, so that following `towards` from the near one gives the nodes in order.
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::vector<double> distance(control.outer.size(), kFar);
    std::vector<int> towards(control.outer.size(), -1);
    std::set<std::pair<double, int>> open{{0.0, stops[i]}};
    distance[stops[i]] = 0;
    while (!open.empty()) {
      const int node = open.begin()->second;
      open.erase(open.begin());
      for (int next : neighbours[node]) {
        const double through = distance[node] + (control.outer[next] - control.outer[node]).norm();
        if (through >= distance[next]) continue;
        open.erase({distance[next], next});
        distance[next] = through;
        towards[next] = node;
        open.insert({through, next});
      }
    }
    if (distance[stops[i - 1]] == kFar)
      throw Refusal(refusal::kUnknownLine,
                    "line '" + line + "' joins two parts of the control mesh that are not connected");
    for (int node = stops[i - 1]; node != stops[i];) route.push_back(node = towards[node]);
  }
  return route;
}

}  // namespace tensegric_fit::geometry
