#include "control_mesh/match_skin.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "control_mesh/pull_back.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRounds = 3, kSpreadRounds = 6;
constexpr int kSamples = 3;          // triangles are sampled in kSamples^2 equal parts
constexpr double kReach = 0.03;      // m; skin farther from a triangle is not the skin below it
constexpr double kMostMove = 0.003;  // m
constexpr double kLeastShare = 0.5;  // of a triangle's area, as it was on the skin
constexpr int kMatchHalvings = 5;

/// Barycentric coordinates of the centres of kSamples^2 equal parts of a triangle.
std::vector<Vector3d> sample_places() {
  std::vector<Vector3d> places;
  const double part = 1.0 / (3 * kSamples);
  for (int i = 0; i < 3 * kSamples; ++i)
    for (int j = 0; i + j <= 3 * kSamples; ++j)
      if (i % 3 == j % 3 && i % 3 != 0) places.emplace_back(i * part, j * part, 1 - (i + j) * part);
  return places;
}

/// Round each node: mean gap between the mesh and the skin outside it, and the area that it is the mean of.
struct Gaps {
  std::vector<double> mean, area;
};

Gaps gaps(const geometry::ControlMesh& control, const Skin& skin) {
  const std::vector<Vector3d> places = sample_places();
  Gaps gap{std::vector<double>(control.outer.size(), 0), std::vector<double>(control.outer.size(), 0)};
  for (const Eigen::Vector3i& k : control.triangles) {
    const Vector3d &a = control.outer[k[0]], &b = control.outer[k[1]], &c = control.outer[k[2]];
    const Vector3d area = geometry::area_vector(a, b, c);
    const Vector3d normal = area.normalized();
    for (const Vector3d& place : places) {
      const Vector3d p = place[0] * a + place[1] * b + place[2] * c;
      const auto foot = skin.nearest_along(p, normal, kReach);
      if (!foot) continue;
      for (int i = 0; i < 3; ++i) {
        const double share = area.norm() * place[i] / static_cast<double>(places.size());
        gap.mean[k[i]] += share * normal.dot(*foot - p);
        gap.area[k[i]] += share;
      }
    }
  }
  for (std::size_t v = 0; v < gap.mean.size(); ++v)
    gap.mean[v] = gap.area[v] > 0 ? gap.mean[v] / gap.area[v] : 0.0;
  return gap;
}

/// What is still missing to the whole, per area of the nodes that can move on.
double missing_height(const Gaps& gap, const std::vector<char>& may_move, const std::vector<double>& moved) {
  double volume = 0, area = 0;
  for (std::size_t v = 0; v < moved.size(); ++v) volume += gap.mean[v] * gap.area[v];
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (may_move[v] && (volume > 0 ? moved[v] < kMostMove : moved[v] > -kMostMove)) area += gap.area[v];
  return area > 0 ? volume / area : 0;
}

}  // namespace

void match_skin(geometry::ControlMesh& control, const std::vector<char>& may_move, const Skin& skin) {
  const std::vector<Vector3d> on_skin = control.outer;
  const auto normals = geometry::vertex_normals(control.outer, control.triangles);
  std::vector<double> moved(on_skin.size(), 0);
  const auto move = [&](std::size_t v, double by) {
    moved[v] = std::clamp(moved[v] + by, -kMostMove, kMostMove);
    control.outer[v] = on_skin[v] + moved[v] * normals[v];
  };
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> gap = gaps(control, skin).mean;
    for (std::size_t v = 0; v < on_skin.size(); ++v)
      if (may_move[v]) move(v, gap[v]);
  }
  // What the strongly curved parts still lack, the others make up for
  for (int round = 0; round < kSpreadRounds; ++round) {
    const double height = missing_height(gaps(control, skin), may_move, moved);
    for (std::size_t v = 0; v < on_skin.size(); ++v)
      if (may_move[v]) move(v, height);
  }
  pull_back(control.outer, on_skin, kMatchHalvings, kMatchHalvings + 1, [&](std::vector<char>& turned) {
    for (const Eigen::Vector3i& k : control.triangles) {
      const Vector3d before = geometry::area_vector(on_skin[k[0]], on_skin[k[1]], on_skin[k[2]]);
      const Vector3d after =
          geometry::area_vector(control.outer[k[0]], control.outer[k[1]], control.outer[k[2]]);
      if (after.dot(before) >= kLeastShare * before.squaredNorm()) continue;
      for (int i = 0; i < 3; ++i) turned[k[i]] = 1;
    }
  });
}

}  // namespace tensegric_fit::control_mesh
