#include "control_mesh/relax.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRounds = 8;
constexpr double kReach = 0.05;  // m; the mean of the neighbours lies no deeper below the skin

}  // namespace

void relax_on_skin(geometry::ControlMesh& control, const std::vector<char>& may_move,
                   const std::vector<std::vector<int>>& around, const Skin& skin) {
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
  }
}

}  // namespace tensegric_fit::control_mesh
