#include "control_mesh/relax.hpp"

#include <algorithm>
#include <array>

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRounds = 8;
constexpr double kReach = 0.05;  // m; the mean of the neighbours lies no deeper below the skin
constexpr int kTurnRounds = 24;  // neighbours take turns
constexpr int kShares = 10;      // of the way between two nodes
constexpr double kLeast = 0.2;   // of lies(): 78 degrees off the skin, corners of 11.5 degrees; nodes are
                                 // still to be lifted by up to 3 mm
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

/// Sine of the sharpest corner.
double sharpest(const std::array<Vector3d, 3>& corners, double twice_area) {
  double least = 1;
  for (int i = 0; i < 3; ++i) {
    const Vector3d u = corners[(i + 1) % 3] - corners[i], v = corners[(i + 2) % 3] - corners[i];
    const double sides = u.norm() * v.norm();
    least = std::min(least, sides > 0 ? twice_area / sides : 0.0);
  }
  return least;
}

/// How well a triangle lies.
struct Lies {
  double cosine;    ///< between its normal and those of the skin nearest to it, the mean of four places
  double sharpest;  ///< sine of its sharpest corner
};

/// With `node` moved to `place`.
Lies lies(const geometry::ControlMesh& control, int triangle, int node, const Vector3d& place,
          const Skin& skin) {
  const Eigen::Vector3i& k = control.triangles[triangle];
  std::array<Vector3d, 3> corners;
  for (int i = 0; i < 3; ++i) corners[i] = k[i] == node ? place : control.outer[k[i]];
  const Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
  Vector3d below = skin.normal_near(middle);
  for (const Vector3d& corner : corners) below += skin.normal_near(0.5 * (middle + corner));
  const Vector3d area = geometry::area_vector(corners[0], corners[1], corners[2]);
  return {area.stableNormalized().dot(below) / 4, sharpest(corners, area.norm())};
}

/// Where a node could go, and how well the worst of its triangles lies there.
struct Move {
  double before = 1, after = 1;
  Vector3d place;
  bool better() const { return after > before; }
};

std::vector<Vector3d> places_round(const geometry::ControlMesh& control, int node, Slide slide,
                                   const GridNeighbours& around, const Skin& skin) {
  std::array<Vector3d, 4> at;
  for (int i = 0; i < 4; ++i) at[i] = control.outer[around[i] < 0 ? node : around[i]];
  const auto& [up, down, left, right] = at;
  std::vector<Vector3d> places;
  if (around[0] >= 0 && around[1] >= 0) places = skin.between(up, down, kShares - 1, right - left);
  if (slide == Slide::either_way && around[2] >= 0 && around[3] >= 0) {
    const auto along_row = skin.between(left, right, kShares - 1, down - up);
    places.insert(places.end(), along_row.begin(), along_row.end());
  }
  return places;
}

}  // namespace

void relax_on_skin(geometry::ControlMesh& control, const std::vector<char>& may_move,
                   const std::vector<GridNeighbours>& around, const Skin& skin) {
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

Badly count_badly_laid(const geometry::ControlMesh& control, const Skin& skin) {
  Badly badly;
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t) {
    const int corner = control.triangles[t][0];
    const Lies how = lies(control, t, corner, control.outer[corner], skin);
    badly.turned += how.cosine <= kLeast;
    badly.sharp += how.sharpest <= kLeast;
  }
  return badly;
}

void turn_back(geometry::ControlMesh& control, const std::vector<Slide>& slides,
               const std::vector<GridNeighbours>& around, const Skin& skin,
               const std::vector<std::vector<Vector3d>>& elsewhere) {
  std::vector<std::vector<int>> triangles(control.outer.size());
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t)
    for (int i = 0; i < 3; ++i) triangles[control.triangles[t][i]].push_back(t);
  const auto worst_at = [&](int node, const Vector3d& place) {
    double worst = 1;
    for (int t : triangles[node]) {
      const Lies how = lies(control, t, node, place, skin);
      worst = std::min({worst, how.cosine, how.sharpest});
    }
    return worst;
  };
  const auto beside = geometry::neighbours_of(control.outer.size(), control.triangles);
  for (int round = 0; round < kTurnRounds; ++round) {
    std::vector<Move> moves(control.outer.size());
    for (int v = 0; v < static_cast<int>(moves.size()); ++v) {
      if (slides[v] == Slide::none) continue;
      moves[v].before = moves[v].after = worst_at(v, control.outer[v]);
      if (moves[v].before > kLeast) continue;
      std::vector<Vector3d> places = places_round(control, v, slides[v], around[v], skin);
      for (const std::vector<Vector3d>& other : elsewhere) places.push_back(other[v]);
      for (const Vector3d& place : places) {
        const double worst = worst_at(v, place);
        if (worst <= moves[v].after) continue;
        moves[v].after = worst;
        moves[v].place = place;
      }
    }
    bool still = true;
    for (std::size_t v = 0; v < moves.size(); ++v) {
      const bool first = std::all_of(beside[v].begin(), beside[v].end(), [&](int other) {
        return !moves[other].better() || moves[v].before <= moves[other].before;
      });
      if (!moves[v].better() || !first) continue;
      control.outer[v] = moves[v].place;
      still = false;
    }
    if (still) return;
  }
}

}  // namespace tensegric_fit::control_mesh
