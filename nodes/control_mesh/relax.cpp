#include "control_mesh/relax.hpp"

#include <algorithm>
#include <array>

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRounds = 8;
constexpr double kReach = 0.05;   // m; the mean of the neighbours lies no deeper below the skin
constexpr int kShares = 10;       // of the way between two nodes
constexpr double kUpright = 0.2;  // cosine to the skin: nodes are still to be lifted by up to 3 mm
constexpr double kTurned = 0.4;   // cosine between a triangle's normal and what it was at first

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

/// Between the triangle's normal, with `node` moved to `place`, and that of the skin below it.
double cosine_to_skin(const geometry::ControlMesh& control, int triangle, int node, const Vector3d& place,
                      const Skin& skin) {
  const Eigen::Vector3i& k = control.triangles[triangle];
  std::array<Vector3d, 3> corners;
  for (int i = 0; i < 3; ++i) corners[i] = k[i] == node ? place : control.outer[k[i]];
  const Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
  Vector3d below = skin.normal_near(middle);
  for (const Vector3d& corner : corners) below += skin.normal_near(0.5 * (middle + corner));
  return geometry::area_vector(corners[0], corners[1], corners[2])
      .stableNormalized()
      .dot(below.stableNormalized());
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

int count_turned(const geometry::ControlMesh& control, const Skin& skin) {
  int turned = 0;
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t) {
    const int corner = control.triangles[t][0];
    turned += cosine_to_skin(control, t, corner, control.outer[corner], skin) <= 0;
  }
  return turned;
}

void turn_back(geometry::ControlMesh& control, const std::vector<char>& may_move,
               const std::vector<std::vector<int>>& around, const Skin& skin) {
  if (count_turned(control, skin) == 0) return;
  std::vector<std::vector<int>> triangles(control.outer.size());
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t)
    for (int i = 0; i < 3; ++i) triangles[control.triangles[t][i]].push_back(t);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vector3d> moved = control.outer;
    for (int v = 0; v < static_cast<int>(moved.size()); ++v) {
      if (!may_move[v]) continue;
      const auto worst_at = [&](const Vector3d& place) {
        double worst = 1;
        for (int t : triangles[v]) worst = std::min(worst, cosine_to_skin(control, t, v, place, skin));
        return worst;
      };
      double best = worst_at(control.outer[v]);
      if (best > kUpright) continue;
      const auto &up = control.outer[around[v][0]], &down = control.outer[around[v][1]],
                 &left = control.outer[around[v][2]], &right = control.outer[around[v][3]];
      auto places = skin.between(up, down, kShares - 1, right - left);
      const auto along_row = skin.between(left, right, kShares - 1, down - up);
      places.insert(places.end(), along_row.begin(), along_row.end());
      for (const Vector3d& place : places) {
        const double worst = worst_at(place);
        if (worst <= best) continue;
        best = worst;
        moved[v] = place;
      }
    }
    if (moved == control.outer) return;
    control.outer = moved;
  }
}

}  // namespace tensegric_fit::control_mesh
