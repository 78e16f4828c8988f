#include "tensegric/unit_prism.hpp"

#include <Eigen/Geometry>

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// The unit's surface, oriented outward: with weight 1 its two triangles, with 1/2 both foldings of each side.
// Seen from corner 0, those at that corner enclose nothing and are left out.
struct Face {
  int a, b, c;
  double weight;
};
constexpr std::array<Face, 7> kFaces = {{{5, 4, 3, 1},
                                         {3, 4, 1, 0.5},
                                         {1, 4, 5, 0.5},
                                         {1, 5, 2, 0.5},
                                         {1, 4, 2, 0.5},
                                         {4, 5, 2, 0.5},
                                         {2, 5, 3, 0.5}}};

Corners seen_from_first(const Corners& corners) {
  Corners seen;
  for (int i = 0; i < 6; ++i) seen[i] = corners[i] - corners[0];
  return seen;
}

}  // namespace

Vector3d centre_of(const std::array<int, 6>& nodes, const Positions& x) {
  Vector3d sum = Vector3d::Zero();
  for (const int node : nodes) sum += x[node];
  return sum / 6;
}

Corners corners_from(const std::array<int, 6>& nodes, const Positions& x, const Vector3d& origin) {
  Corners corners;
  for (int i = 0; i < 6; ++i) corners[i] = x[nodes[i]] - origin;
  return corners;
}

bool moves(const std::array<int, 6>& nodes, const std::vector<int>& free_index) {
  for (const int node : nodes)
    if (free_index[node] >= 0) return true;
  return false;
}

double unit_volume(const Corners& corners) {
  const Corners p = seen_from_first(corners);
  double volume = 0;
  for (const Face& f : kFaces) volume += f.weight / 6 * p[f.a].dot(p[f.b].cross(p[f.c]));
  return volume;
}

// Moved as a whole, a unit keeps its volume: corner 0 has what the others lack.
Corners volume_gradient(const Corners& corners) {
  const Corners p = seen_from_first(corners);
  Corners g;
  g.fill(Vector3d::Zero());
  for (const Face& f : kFaces) {
    g[f.a] += f.weight / 6 * p[f.b].cross(p[f.c]);
    g[f.b] += f.weight / 6 * p[f.c].cross(p[f.a]);
    g[f.c] += f.weight / 6 * p[f.a].cross(p[f.b]);
  }
  for (int i = 1; i < 6; ++i) g[0] -= g[i];
  return g;
}

VolumeHessian volume_hessian(const Corners& corners) {
  const Corners p = seen_from_first(corners);
  VolumeHessian second;
  for (auto& row : second) row.fill(Vector3d::Zero());
  // By a, then b, of a . (b x c): v -> -c x v.
  const auto add = [&second](int a, int b, const Vector3d& by) {
    if (a > b)
      second[a][b] -= by;
    else
      second[b][a] += by;
  };
  for (const Face& f : kFaces) {
    add(f.a, f.b, f.weight / 6 * p[f.c]);
    add(f.b, f.c, f.weight / 6 * p[f.a]);
    add(f.c, f.a, f.weight / 6 * p[f.b]);
  }
  for (int i = 1; i < 6; ++i) {
    for (int j = 1; j < i; ++j) second[i][0] -= second[i][j];
    for (int j = i + 1; j < 6; ++j) second[i][0] += second[j][i];
  }
  return second;
}

double upright_volume(const Corners& p) {
  const double area = geometry::area_vector(p[0], p[1], p[2]).norm() / 2;
  return area * ((p[0] - p[3]).norm() + (p[1] - p[4]).norm() + (p[2] - p[5]).norm()) / 3;
}

}  // namespace tensegric_fit::tensegric
