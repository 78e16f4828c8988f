#include "tffd/reach.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "geometry/disjoint_sets.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::tffd {
namespace {

struct Border {
  bool open = false;                     // the control mesh has a rim
  std::vector<double> depth;             // per outer node: 0 on a fixed border and in fixed triangles, else 1
  std::vector<std::array<char, 3>> rim;  // per triangle: side opposite to corner k is on the rim
};

Border border_of(const geometry::ControlMesh& control) {
  std::vector<char> moves(control.triangles.size(), 0);
  for (std::size_t t = 0; t < moves.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int node = control.triangles[t][k];
      if (!control.outer_fixed[node] || !control.inner_fixed[node]) moves[t] = 1;
    }
  Border border;
  border.depth.assign(control.outer.size(), 1);
  border.rim.assign(moves.size(), {0, 0, 0});
  const auto still = [&](int node) {
    if (control.outer_fixed[node]) border.depth[node] = 0;
  };
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles})) {
    if (edge.right < 0) {
      border.open = true;
      const Eigen::Vector3i& t = control.triangles[edge.left];
      for (int k = 0; k < 3; ++k)
        if (t[k] != edge.first && t[k] != edge.second) border.rim[edge.left][k] = 1;
    }
    const bool both_move = moves[edge.left] && edge.right >= 0 && moves[edge.right];
    if (both_move) continue;
    still(edge.first);
    still(edge.second);
  }
  return border;
}

struct Closest {
  int triangle = -1;
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // from the closest point to the vertex
};

// Among `candidates` that face as `facing` does (all, where it is null) and are nearer than `reach` of their
// radii.
template <typename Candidates>
Closest closest_triangle(const Eigen::Vector3d& q, const Eigen::Vector3d* facing,
                         const std::vector<Frame>& frames, const Candidates& candidates, double reach) {
  Closest closest;
  for (const int t : candidates) {
    const Frame& frame = frames[t];
    if (frame.farther_than(std::min(closest.distance, reach * frame.radius), q)) continue;
    if (facing && !(facing->dot(frame.normal) > 0)) continue;
    const Eigen::Vector3d barycentric = frame.closest(q);
    const Eigen::Vector3d offset = q - frame.at(barycentric);
    const double distance = offset.norm();
    if (distance >= closest.distance || distance > reach * frame.radius) continue;
    closest = {t, distance, barycentric, offset};
  }
  return closest;
}

double share_at(const Closest& closest, const geometry::ControlMesh& control, const Border& border,
                const Frame& frame, double reach) {
  const Eigen::Vector3i& t = control.triangles[closest.triangle];
  double depth = 0;
  bool on_rim = false;
  for (int k = 0; k < 3; ++k) {
    depth += closest.barycentric[k] * border.depth[t[k]];
    if (closest.barycentric[k] == 0 && border.rim[closest.triangle][k]) on_rim = true;
  }
  // Quadratic, not a smoothstep: the motion itself grows with depth, and the product should not be much
  // steeper.
  double share = 1 - (1 - depth) * (1 - depth);
  if (on_rim) {
    const double beyond = (closest.offset - frame.normal * frame.normal.dot(closest.offset)).norm();
    const double z = std::min(1.0, beyond / (reach * frame.radius));
    share *= (1 - z) * (1 - z) * (1 + 2 * z);
  }
  return share;
}

// Anchors that body edges join, over anchors, to the vertex nearest to one of the nodes that may move.
std::vector<Anchor> joined_to_nodes(const std::vector<Anchor>& anchors, const geometry::TriangleMesh& body,
                                    const geometry::ControlMesh& control, const Border& border) {
  std::vector<int> anchor_of(body.vertices.size(), -1);
  for (std::size_t i = 0; i < anchors.size(); ++i) anchor_of[anchors[i].vertex] = static_cast<int>(i);
  std::vector<Eigen::Vector3i> triangles;
  for (const Eigen::Vector3i& t : body.triangles)
    if (anchor_of[t[0]] >= 0 && anchor_of[t[1]] >= 0 && anchor_of[t[2]] >= 0)
      triangles.emplace_back(anchor_of[t[0]], anchor_of[t[1]], anchor_of[t[2]]);
  const std::vector<std::vector<int>> neighbours = geometry::neighbours_of(anchors.size(), triangles);

  std::vector<char> joined(anchors.size(), 0);
  std::vector<int> front;
  for (std::size_t node = 0; node < control.outer.size(); ++node) {
    if (border.depth[node] == 0) continue;
    int nearest = -1;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      const double distance = (body.vertices[anchors[i].vertex] - control.outer[node]).squaredNorm();
      if (distance < best) best = distance, nearest = static_cast<int>(i);
    }
    if (nearest >= 0 && !joined[nearest]) joined[nearest] = 1, front.push_back(nearest);
  }
  while (!front.empty()) {
    const int i = front.back();
    front.pop_back();
    for (const int next : neighbours[i])
      if (!joined[next]) joined[next] = 1, front.push_back(next);
  }
  std::vector<Anchor> kept;
  for (std::size_t i = 0; i < anchors.size(); ++i)
    if (joined[i]) kept.push_back(anchors[i]);
  return kept;
}

void add_anchor(int vertex, const Closest& closest, const geometry::ControlMesh& control,
                const Border& border, const std::vector<Frame>& frames, double reach,
                std::vector<Anchor>& anchors) {
  if (closest.triangle < 0) return;
  const double share = share_at(closest, control, border, frames[closest.triangle], reach);
  if (share > 0) anchors.push_back({vertex, share});
}

// Skin that faces otherwise than all triangles near it, but is surrounded by skin that is carried, as a
// nipple's crumple or the bottom of a fold: left where it is it would hold the skin round it. `turned`: by
// vertex, the nearest triangle whichever way it faces, of vertices that are no anchors.
std::vector<int> surrounded(const geometry::TriangleMesh& body, const std::vector<Anchor>& anchors,
                            const std::map<int, Closest>& turned) {
  if (turned.empty()) return {};
  std::vector<char> is_carried(body.vertices.size(), 0), goes_on(body.vertices.size(), 0),
      is_beside(body.vertices.size(), 0);
  for (const Anchor& anchor : anchors) is_carried[anchor.vertex] = 1;
  geometry::DisjointSets pieces(body.vertices.size());  // of what is not carried
  const std::vector<geometry::Edge> edges = geometry::edges_of(body);
  for (const geometry::Edge& edge : edges)
    if (!is_carried[edge.first] && !is_carried[edge.second]) pieces.join(edge.first, edge.second);
  for (const geometry::Edge& edge : edges)
    if (is_carried[edge.first] != is_carried[edge.second])
      is_beside[pieces.root(is_carried[edge.first] ? edge.second : edge.first)] = 1;
  for (int v = 0; v < static_cast<int>(body.vertices.size()); ++v)
    if (!is_carried[v] && turned.count(v) == 0) goes_on[pieces.root(v)] = 1;
  std::vector<int> inside;
  for (const auto& [v, closest] : turned)
    if (is_beside[pieces.root(v)] && !goes_on[pieces.root(v)]) inside.push_back(v);
  return inside;
}

// What a control mesh with a border carries, whichever skin it belongs to.
std::vector<Anchor> carried(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                            const Border& border, const std::vector<Frame>& frames, const TriangleGrid& grid,
                            double reach) {
  const auto normals = geometry::vertex_normals(body.vertices, body.triangles);
  std::vector<Anchor> anchors;
  std::map<int, Closest> turned;
  for (int v = 0; v < static_cast<int>(body.vertices.size()); ++v) {
    const Eigen::Vector3d& q = body.vertices[v];
    const auto near = grid.near(q);
    Closest closest = closest_triangle(q, &normals[v], frames, near, reach);
    if (closest.triangle >= 0) {
      add_anchor(v, closest, control, border, frames, reach, anchors);
    } else if (closest = closest_triangle(q, nullptr, frames, near, reach); closest.triangle >= 0) {
      turned.emplace(v, closest);
    }
  }
  for (const int v : surrounded(body, anchors, turned))
    add_anchor(v, turned.at(v), control, border, frames, reach, anchors);
  std::sort(anchors.begin(), anchors.end(),
            [](const Anchor& a, const Anchor& b) { return a.vertex < b.vertex; });
  return anchors;
}

// Where the skin turns away from the control mesh, as between the thighs, what is carried ends without a
// border: there the share grows from 0 with the way over the skin.
void ease_edges(std::vector<Anchor>& anchors, const geometry::TriangleMesh& body,
                const std::vector<Frame>& frames) {
  constexpr double kWay =
      0.75;        // mean radii of the triangles: steeper, skin turns over at 15 % shorter lines
  double way = 0;  // to a whole share
  for (const Frame& frame : frames) way += kWay * frame.radius / static_cast<double>(frames.size());
  std::vector<double> distance(body.vertices.size(), 0);
  for (const Anchor& anchor : anchors) distance[anchor.vertex] = way;
  std::vector<Eigen::Vector3i> touched;
  for (const Eigen::Vector3i& t : body.triangles)
    if (distance[t[0]] + distance[t[1]] + distance[t[2]] > 0) touched.push_back(t);
  const auto neighbours = geometry::neighbours_of(body.vertices.size(), touched);
  std::set<std::pair<double, int>> open;
  const auto visit_from = [&](int vertex) {
    for (const int next : neighbours[vertex]) {
      const double through = distance[vertex] + (body.vertices[next] - body.vertices[vertex]).norm();
      if (through >= distance[next]) continue;
      open.erase({distance[next], next});
      distance[next] = through;
      open.insert({through, next});
    }
  };
  for (std::size_t v = 0; v < distance.size(); ++v)
    if (distance[v] == 0) visit_from(static_cast<int>(v));
  while (!open.empty()) {
    const int vertex = open.begin()->second;
    open.erase(open.begin());
    visit_from(vertex);
  }
  for (Anchor& anchor : anchors) anchor.share = std::min(anchor.share, distance[anchor.vertex] / way);
}

// What a closed control mesh with fixed nodes carries: all but the skin over the fixed ones.
std::vector<Anchor> carried_by_closed(const std::vector<Eigen::Vector3d>& vertices,
                                      const geometry::ControlMesh& control, const Border& border,
                                      const std::vector<Frame>& frames, const TriangleGrid& grid,
                                      double reach) {
  constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
  std::vector<int> all(frames.size());
  std::iota(all.begin(), all.end(), 0);
  double sure = kAnyDistance;  // the grid misses no triangle that is nearer
  for (const Frame& frame : frames) sure = std::min(sure, reach * frame.radius);
  std::vector<Anchor> anchors;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Eigen::Vector3d& q = vertices[v];
    Closest closest = closest_triangle(q, nullptr, frames, grid.near(q), kAnyDistance);
    if (closest.distance > sure) closest = closest_triangle(q, nullptr, frames, all, kAnyDistance);
    add_anchor(static_cast<int>(v), closest, control, border, frames, kAnyDistance, anchors);
  }
  return anchors;
}

}  // namespace

std::vector<Anchor> reach_of(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                             const std::vector<Frame>& frames, const TriangleGrid& grid, double reach) {
  const Border border = border_of(control);
  if (border.open) {
    if (body.triangles.empty())
      throw geometry::Refusal(geometry::refusal::kBadMesh,
                              "a control mesh with a border needs the body's triangles, and it has none");
    std::vector<Anchor> anchors =
        joined_to_nodes(carried(body, control, border, frames, grid, reach), body, control, border);
    ease_edges(anchors, body, frames);
    return anchors;
  }
  if (std::count(border.depth.begin(), border.depth.end(), 0) > 0)
    return carried_by_closed(body.vertices, control, border, frames, grid, reach);
  std::vector<Anchor> all;
  for (std::size_t v = 0; v < body.vertices.size(); ++v) all.push_back({static_cast<int>(v), 1});
  return all;
}

}  // namespace tensegric_fit::tffd
