#include "geometry/cut_off.hpp"

#include <map>

namespace tensegric_fit::geometry {
namespace {

/// True for the vertices of pieces that go.
std::vector<char> gone_vertices(const TriangleMesh& mesh, const std::vector<double>& distance,
                                const std::function<bool(const std::vector<int>&)>& goes) {
  const auto neighbours = neighbours_of(mesh.vertices.size(), mesh.triangles);
  std::vector<char> gone(mesh.vertices.size(), 0), seen(mesh.vertices.size(), 0);
  for (std::size_t first = 0; first < gone.size(); ++first) {
    if (seen[first] || distance[first] <= 0) continue;
    std::vector<int> piece{static_cast<int>(first)};
    seen[first] = 1;
    for (std::size_t i = 0; i < piece.size(); ++i)
      for (const int next : neighbours[piece[i]])
        if (!seen[next] && distance[next] > 0) {
          seen[next] = 1;
          piece.push_back(next);
        }
    if (goes(piece))
      for (const int v : piece) gone[v] = 1;
  }
  return gone;
}

class Cut {
 public:
  Cut(const TriangleMesh& mesh, const std::vector<double>& distance, const std::vector<char>& gone)
      : distance_(distance), gone_(gone) {
    cut_.left.assign(mesh.vertices.size(), -1);
    for (std::size_t v = 0; v < gone.size(); ++v) {
      if (gone[v]) continue;
      cut_.left[v] = static_cast<int>(cut_.vertices.size());
      cut_.vertices.push_back({{static_cast<int>(v), 1.0}});
    }
    for (const Eigen::Vector3i& triangle : mesh.triangles) add(triangle);
    close();
  }

  CutMesh take() { return std::move(cut_); }

 private:
  /// Where the edge from a vertex that stays to one that goes meets the plane.
  int crossing(int stays, int goes) {
    const auto [at, is_new] = crossings_.try_emplace({stays, goes}, static_cast<int>(cut_.vertices.size()));
    if (is_new) {
      const double share = distance_[stays] / (distance_[stays] - distance_[goes]);
      cut_.vertices.push_back({{stays, 1 - share}, {goes, share}});
    }
    return at->second;
  }

  void add(const Eigen::Vector3i& triangle) {
    const int going = gone_[triangle[0]] + gone_[triangle[1]] + gone_[triangle[2]];
    if (going == 3) return;
    const auto now = [&](int v) { return cut_.left[v]; };
    if (going == 0) {
      cut_.triangles.emplace_back(now(triangle[0]), now(triangle[1]), now(triangle[2]));
      return;
    }
    int k = 0;  // the corner that is alone on its side
    while ((gone_[triangle[k]] != 0) != (going == 1)) ++k;
    const int alone = triangle[k], next = triangle[(k + 1) % 3], last = triangle[(k + 2) % 3];
    if (going == 1) {
      const int a = crossing(next, alone), b = crossing(last, alone);
      cut_.triangles.emplace_back(a, now(next), now(last));
      cut_.triangles.emplace_back(a, now(last), b);
      rim_[b] = a;
    } else {
      const int a = crossing(alone, next), b = crossing(alone, last);
      cut_.triangles.emplace_back(now(alone), a, b);
      rim_[a] = b;
    }
  }

  /// A fan over each loop of the rim, or over each chain where the mesh was open there.
  void close() {
    while (!rim_.empty()) {
      std::vector<std::pair<int, int>> loop;
      for (auto side = rim_.begin(); side != rim_.end(); side = rim_.find(loop.back().second)) {
        loop.emplace_back(*side);
        rim_.erase(side);
      }
      std::map<int, double> mean;
      for (const auto& [from, to] : loop)
        for (const auto& [v, weight] : cut_.vertices[from])
          mean[v] += weight / static_cast<double>(loop.size());
      const int centre = static_cast<int>(cut_.vertices.size());
      cut_.vertices.emplace_back(mean.begin(), mean.end());
      for (const auto& [from, to] : loop) cut_.triangles.emplace_back(to, from, centre);
    }
  }

  const std::vector<double>& distance_;
  const std::vector<char>& gone_;
  std::map<std::pair<int, int>, int> crossings_;
  std::map<int, int> rim_;  // sides of the cut, as the triangles below run
  CutMesh cut_;
};

}  // namespace

CutMesh cut_off(const TriangleMesh& mesh, const Eigen::Hyperplane<double, 3>& plane,
                const std::function<bool(const std::vector<int>&)>& goes) {
  std::vector<double> distance;
  for (const Eigen::Vector3d& vertex : mesh.vertices) distance.push_back(plane.signedDistance(vertex));
  return Cut(mesh, distance, gone_vertices(mesh, distance, goes)).take();
}

}  // namespace tensegric_fit::geometry
