#include "reconstruction/handles.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include "geometry/disjoint_sets.hpp"
#include "reconstruction/sides.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using geometry::TriangleMesh;

constexpr int kMostHandles = 32;
constexpr int kRoots = 6;  // loops through that many vertices are tried for each handle

struct Loop {
  std::vector<int> edges;
  int vertex = 0;  // on the loop, far from the root that it was found from
  double length = std::numeric_limits<double>::infinity();
};

class Graph {
 public:
  explicit Graph(const TriangleMesh& mesh)
      : mesh_(mesh), edges_(geometry::edges_of(mesh)), edges_at_(mesh.vertices.size()) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      lengths_.push_back((mesh.vertices[edges_[e].first] - mesh.vertices[edges_[e].second]).norm());
      edges_at_[edges_[e].first].push_back(static_cast<int>(e));
      edges_at_[edges_[e].second].push_back(static_cast<int>(e));
    }
  }

  const geometry::Edge& edge(int e) const { return edges_[e]; }

  /// A short loop that does not part the surface, from the shortest paths from `root`; none has infinite
  /// length.
  Loop loop_from(int root) const {
    std::vector<int> towards_root;
    std::vector<double> distance;
    shortest_paths(root, towards_root, distance);
    std::vector<char> in_tree(edges_.size());
    for (int e : towards_root)
      if (e >= 0) in_tree[e] = 1;
    // A tree of triangles across the other edges, longest loops first: what it does not cross closes loops
    // that do not part the surface.
    std::vector<std::pair<double, int>> by_length;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (!in_tree[e])
        by_length.emplace_back(
            -(distance[edges_[e].first] + distance[edges_[e].second] + length(static_cast<int>(e))),
            static_cast<int>(e));
    std::sort(by_length.begin(), by_length.end());
    geometry::DisjointSets tree(mesh_.triangles.size());
    Loop best;
    for (const auto& [minus_length, e] : by_length) {
      if (tree.join(edges_[e].left, edges_[e].right)) continue;
      Loop loop = closed_by(e, towards_root);
      if (loop.length < best.length) best = std::move(loop);
    }
    return best;
  }

 private:
  double length(int e) const { return lengths_[e]; }
  int other_end(int e, int v) const { return edges_[e].first == v ? edges_[e].second : edges_[e].first; }

  void shortest_paths(int root, std::vector<int>& towards_root, std::vector<double>& distance) const {
    towards_root.assign(mesh_.vertices.size(), -1);
    distance.assign(mesh_.vertices.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> front;
    distance[root] = 0;
    front.emplace(0.0, root);
    while (!front.empty()) {
      const auto [reached, v] = front.top();
      front.pop();
      if (reached > distance[v]) continue;
      for (int e : edges_at_[v]) {
        const int w = other_end(e, v);
        if (reached + length(e) >= distance[w]) continue;
        distance[w] = reached + length(e);
        towards_root[w] = e;
        front.emplace(distance[w], w);
      }
    }
  }

  /// Edge e and the paths from its ends to where they meet.
  Loop closed_by(int e, const std::vector<int>& towards_root) const {
    std::vector<char> on_path(mesh_.vertices.size());
    for (int v = edges_[e].first;; v = other_end(towards_root[v], v)) {
      on_path[v] = 1;
      if (towards_root[v] < 0) break;
    }
    Loop loop{{e}, edges_[e].first, length(e)};
    const auto follow = [&](int v, int end) {
      for (; v != end; v = other_end(towards_root[v], v)) {
        loop.edges.push_back(towards_root[v]);
        loop.length += length(towards_root[v]);
      }
    };
    int meeting = edges_[e].second;
    while (!on_path[meeting]) meeting = other_end(towards_root[meeting], meeting);
    follow(edges_[e].first, meeting);
    follow(edges_[e].second, meeting);
    return loop;
  }

  const TriangleMesh& mesh_;
  std::vector<geometry::Edge> edges_;
  std::vector<double> lengths_;  // m
  std::vector<std::vector<int>> edges_at_;
};

/// Cuts along the loop and closes both rims.
TriangleMesh cut(const TriangleMesh& mesh, const Graph& graph, const Loop& loop) {
  std::vector<int> across = sides_across(mesh);
  for (int e : loop.edges) {
    const geometry::Edge& edge = graph.edge(e);
    for (int k = 0; k < 3; ++k) {
      const int side = 3 * edge.left + k;
      if (mesh.triangles[edge.left][k] != edge.first || mesh.triangles[edge.left][(k + 1) % 3] != edge.second)
        continue;
      across[across[side]] = -1;
      across[side] = -1;
    }
  }
  TriangleMesh result = split_fans(mesh, across);
  close_loops(result);
  return result;
}

}  // namespace

int genus(const TriangleMesh& mesh) {
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  return 1 - (count(mesh.vertices) - 3 * count(mesh.triangles) / 2 + count(mesh.triangles)) / 2;
}

TriangleMesh without_handles(const TriangleMesh& mesh, double longest) {
  TriangleMesh result = mesh;
  for (int handle = 0; handle < kMostHandles && genus(result) > 0; ++handle) {
    const Graph graph(result);
    Loop best = graph.loop_from(0);
    for (int root = 1; root < kRoots; ++root) {
      Loop next = graph.loop_from(best.vertex);
      if (!(next.length < best.length)) break;
      best = std::move(next);
    }
    if (!(best.length < longest)) break;
    result = cut(result, graph, best);
  }
  return result;
}

}  // namespace tensegric_fit::reconstruction
