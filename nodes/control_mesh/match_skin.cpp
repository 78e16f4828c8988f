#include "control_mesh/match_skin.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRounds = 3;
constexpr int kSamples = 3;          // triangles are sampled in kSamples^2 equal parts
constexpr double kReach = 0.03;      // m; skin farther from a triangle is not the skin below it
constexpr double kMostMove = 0.003;  // m

/// Barycentric coordinates of the centres of kSamples^2 equal parts of a triangle.
std::vector<Vector3d> sample_places() {
  std::vector<Vector3d> places;
  const double part = 1.0 / (3 * kSamples);
  for (int i = 0; i < 3 * kSamples; ++i)
    for (int j = 0; i + j <= 3 * kSamples; ++j)
      if (i % 3 == j % 3 && i % 3 != 0) places.emplace_back(i * part, j * part, 1 - (i + j) * part);
  return places;
}

/// Mean gap between the mesh and the skin outside it round each node, weighted by area and nearness.
std::vector<double> gaps(const geometry::ControlMesh& control, const Skin& skin) {
  const std::vector<Vector3d> places = sample_places();
  std::vector<double> sum(control.outer.size(), 0), weight(control.outer.size(), 0);
  for (const Eigen::Vector3i& k : control.triangles) {
    const Vector3d &a = control.outer[k[0]], &b = control.outer[k[1]], &c = control.outer[k[2]];
    const Vector3d area = geometry::area_vector(a, b, c);
    const Vector3d normal = area.normalized();
    for (const Vector3d& place : places) {
      const Vector3d p = place[0] * a + place[1] * b + place[2] * c;
      const auto foot = skin.nearest_along(p, normal, kReach);
      if (!foot) continue;
      for (int i = 0; i < 3; ++i) {
        sum[k[i]] += area.norm() * place[i] * normal.dot(*foot - p);
        weight[k[i]] += area.norm() * place[i];
      }
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = weight[v] > 0 ? sum[v] / weight[v] : 0.0;
  return sum;
}

}  // namespace

void match_skin(geometry::ControlMesh& control, const std::vector<char>& may_move, const Skin& skin) {
  const std::vector<Vector3d> on_skin = control.outer;
  const auto normals = geometry::vertex_normals(control.outer, control.triangles);
  std::vector<double> moved(on_skin.size(), 0);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> gap = gaps(control, skin);
    for (std::size_t v = 0; v < on_skin.size(); ++v) {
      if (!may_move[v]) continue;
      moved[v] = std::clamp(moved[v] + gap[v], -kMostMove, kMostMove);
      control.outer[v] = on_skin[v] + moved[v] * normals[v];
    }
  }
}

}  // namespace tensegric_fit::control_mesh
