#include "control_mesh/inner_nodes.hpp"

#include <algorithm>

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr double kShareOfBody = 0.4;  // of the way through the body: the inner node stays inside
constexpr double kLeastShare =
    0.1;  // of the outer triangle's area that the inner one must keep, facing the same way
constexpr int kSmoothingRounds = 2;
constexpr double kShrink = 0.9;
constexpr int kMostRounds = 40;
constexpr double kBelowSkin = 1e-4;   // m; where the ray through the body starts, or
constexpr double kBelowShare = 0.01;  // of the thickness where that is less

/// Normals averaged with those around them: below a sharp fold the inner nodes spread out all the same.
std::vector<Vector3d> smooth_normals(const geometry::ControlMesh& control) {
  std::vector<Vector3d> normals = geometry::vertex_normals(control.outer, control.triangles);
  const auto around = geometry::neighbours_of(control.outer.size(), control.triangles);
  for (int round = 0; round < kSmoothingRounds; ++round) {
    const std::vector<Vector3d> before = normals;
    for (std::size_t v = 0; v < normals.size(); ++v) {
      Vector3d mean = Vector3d::Zero();
      for (int neighbour : around[v]) mean += before[neighbour];
      normals[v] = (before[v] + mean / static_cast<double>(around[v].size())).normalized();
    }
  }
  return normals;
}

}  // namespace

void place_inner_nodes(geometry::ControlMesh& control, std::vector<double> thickness, const Skin& skin) {
  const std::vector<Vector3d> normals = smooth_normals(control);
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    const Vector3d below = control.outer[v] - std::min(kBelowSkin, kBelowShare * thickness[v]) * normals[v];
    const auto far_side = skin.first_exit(below, -normals[v], thickness[v] / kShareOfBody);
    if (far_side) thickness[v] = std::min(thickness[v], kShareOfBody * (*far_side - below).norm());
  }
  for (std::size_t v = 0; v < thickness.size(); ++v)
    control.inner[v] = control.outer[v] - thickness[v] * normals[v];
  thin_folded_units(control);
}

void thin_folded_units(geometry::ControlMesh& control) {
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<char> too_thick(control.outer.size(), 0);
    for (const Eigen::Vector3i& k : control.triangles) {
      const Vector3d outer =
          geometry::area_vector(control.outer[k[0]], control.outer[k[1]], control.outer[k[2]]);
      const Vector3d inner =
          geometry::area_vector(control.inner[k[0]], control.inner[k[1]], control.inner[k[2]]);
      if (inner.dot(outer) < kLeastShare * outer.squaredNorm())
        for (int i = 0; i < 3; ++i) too_thick[k[i]] = 1;
    }
    if (std::find(too_thick.begin(), too_thick.end(), 1) == too_thick.end()) return;
    for (std::size_t v = 0; v < too_thick.size(); ++v)
      if (too_thick[v]) control.inner[v] = control.outer[v] + kShrink * (control.inner[v] - control.outer[v]);
  }
}

}  // namespace tensegric_fit::control_mesh
