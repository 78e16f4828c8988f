#include "control_mesh/relax.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRounds = 8;
constexpr double kReach = 0.05;  // m; the mean of the neighbours lies no deeper below the skin
constexpr double kTurned = 0.4;  // cosine between a triangle's normal and what it was at first

/// Nodes go back where a triangle of theirs has turned too far: in folds means are soon on the other side.
void undo_turns(geometry::ControlMesh& control, const std::vector<Vector3d>& before,
                const std::vector<Vector3d>& first) {
  for (std::size_t t = 0; t < control.triangles.size(); ++t) {
    const Eigen::Vector3i& k = control.triangles[t];
    const Vector3d area =
        geometry::area_vector(control.outer[k[0]], control.outer[k[1]], control.outer[k[2]]);
    if (area.dot(first[t]) >= kTurned * area.norm() * first[t].norm()) continue;
    for (int i = 0; i < 3; ++i) control.outer[k[i]] = before[k[i]];
  }
}

}  // namespace

void relax_on_skin(geometry::ControlMesh& control, const std::vector<char>& may_move,
                   const std::vector<std::vector<int>>& around, const Skin& skin) {
  std::vector<Vector3d> first;  // normals
  for (const Eigen::Vector3i& k : control.triangles)
    first.push_back(geometry::area_vector(control.outer[k[0]], control.outer[k[1]], control.outer[k[2]]));
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Vector3d> before = control.outer;
    const auto normals = geometry::vertex_normals(before, control.triangles);
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (!may_move[v]) continue;
      Vector3d mean = Vector3d::Zero();
      for (int neighbour : around[v]) mean += before[neighbour];
      mean /= static_cast<double>(around[v].size());
      const Vector3d halfway = 0.5 * (before[v] + mean);
      const auto above = skin.nearest_along(halfway, normals[v], kReach);
      control.outer[v] = above ? *above : skin.nearest(halfway);
    }
    undo_turns(control, before, first);
  }
}

}  // namespace tensegric_fit::control_mesh
