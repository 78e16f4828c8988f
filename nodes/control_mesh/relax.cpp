#include "control_mesh/relax.hpp"

#include <algorithm>
#include <array>

#include "control_mesh/pull_back.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr int kRelaxRounds = 8;
constexpr double kDeepestMean = 0.05;  // m; the mean of the neighbours lies no deeper below the skin
constexpr int kTurnRounds = 24;        // neighbours take turns
constexpr int kShares = 10;            // of the way between two nodes
constexpr double kLeast = 0.2;   // of along_skin() and sharpest(): 78 degrees off the skin, corners of 11.5
                                 // degrees; nodes are still to be lifted by up to 3 mm
constexpr double kTurned = 0.4;  // cosine between a triangle's normal and what it was at first

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

std::array<Vector3d, 3> corners_of(const geometry::ControlMesh& control, int triangle) {
  const Eigen::Vector3i& k = control.triangles[triangle];
  return {control.outer[k[0]], control.outer[k[1]], control.outer[k[2]]};
}

Vector3d area_of(const std::array<Vector3d, 3>& corners) {
  return geometry::area_vector(corners[0], corners[1], corners[2]);
}

/// Cosine between its normal and those of the skin nearest to it, the mean of four places.
double along_skin(const std::array<Vector3d, 3>& corners, const Skin& skin) {
  const Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3;
  Vector3d below = skin.normal_near(middle);
  for (const Vector3d& corner : corners) below += skin.normal_near(0.5 * (middle + corner));
  return area_of(corners).stableNormalized().dot(below) / 4;
}

/// Where a node could go, and how well the worst of its triangles lies there.
struct Move {
  double before = 1, after = 1;
  Vector3d place, mirrored;  ///< of the node, and of the one that moves with it
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
  for (int round = 0; round < kRelaxRounds; ++round) {
    const std::vector<Vector3d> before = control.outer;
    const auto normals = geometry::vertex_normals(before, control.triangles);
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (!may_move[v]) continue;
      Vector3d mean = Vector3d::Zero();
      for (int neighbour : around[v]) mean += before[neighbour];
      mean /= static_cast<double>(around[v].size());
      const Vector3d halfway = 0.5 * (before[v] + mean);
      const auto above = skin.nearest_along(halfway, normals[v], kDeepestMean);
      control.outer[v] = above ? *above : skin.nearest(halfway);
    }
    pull_back(control.outer, before, 0, 1, [&](std::vector<char>& turned) {
      for (std::size_t t = 0; t < first.size(); ++t) {
        const Vector3d area = area_of(corners_of(control, static_cast<int>(t)));
        if (area.dot(first[t]) >= kTurned * area.norm() * first[t].norm()) continue;
        for (int i = 0; i < 3; ++i) turned[control.triangles[t][i]] = 1;
      }
    });
  }
}

Badly count_badly_laid(const geometry::ControlMesh& control, const Skin& skin) {
  Badly badly;
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t) {
    const std::array<Vector3d, 3> corners = corners_of(control, t);
    badly.turned += along_skin(corners, skin) <= kLeast;
    badly.sharp += sharpest(corners, area_of(corners).norm()) <= kLeast;
  }
  return badly;
}

void turn_back(geometry::ControlMesh& control, const Slides& slides, const Skin& skin,
               const std::vector<std::vector<Vector3d>>& elsewhere) {
  const auto other_side = [&](int v) { return slides.mirrored.empty() ? v : slides.mirrored[v]; };
  std::vector<std::vector<int>> triangles(control.outer.size());
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t)
    for (int i = 0; i < 3; ++i) triangles[control.triangles[t][i]].push_back(t);
  // How well the worst triangle lies with `node` moved to `place`; anything up to `enough` where it is no
  // better than that. Corners come first: the skin is asked only where they are good enough.
  const auto worst_at = [&](int node, const Vector3d& place, double enough) {
    std::vector<std::array<Vector3d, 3>> round;
    double worst = 1;
    for (int t : triangles[node]) {
      round.push_back(corners_of(control, t));
      for (int i = 0; i < 3; ++i)
        if (control.triangles[t][i] == node) round.back()[i] = place;
      worst = std::min(worst, sharpest(round.back(), area_of(round.back()).norm()));
    }
    for (std::size_t i = 0; i < round.size() && worst > enough; ++i)
      worst = std::min(worst, along_skin(round[i], skin));
    return worst;
  };
  const auto places_of = [&](int v, const GridNeighbours& around) {
    std::vector<Vector3d> places = places_round(control, v, slides.of[v], around, skin);
    for (const std::vector<Vector3d>& other : elsewhere) places.push_back(other[v]);
    return places;
  };
  const auto best_move = [&](int v) {
    const int w = other_side(v);
    Move move;
    move.before = worst_at(v, control.outer[v], -1);
    if (w != v) move.before = std::min(move.before, worst_at(w, control.outer[w], -1));
    move.after = move.before;
    if (move.before > kLeast) return move;
    const std::vector<Vector3d> places = places_of(v, slides.around[v]);
    std::vector<Vector3d> mirrored = places;
    if (w != v) {
      GridNeighbours around = slides.around[w];
      std::swap(around[2], around[3]);  // left and right
      mirrored = places_of(w, around);
    }
    for (std::size_t i = 0; i < std::min(places.size(), mirrored.size()); ++i) {
      double worst = worst_at(v, places[i], move.after);
      if (w != v && worst > move.after) worst = std::min(worst, worst_at(w, mirrored[i], move.after));
      if (worst <= move.after) continue;
      move.after = worst;
      move.place = places[i];
      move.mirrored = mirrored[i];
    }
    return move;
  };
  const auto beside = geometry::neighbours_of(control.outer.size(), control.triangles);
  std::vector<Move> moves(control.outer.size());
  std::vector<char> stale(moves.size(), 1);  // something near has moved since its move was looked for
  for (int round = 0; round < kTurnRounds; ++round) {
    for (int v = 0; v < static_cast<int>(moves.size()); ++v)
      if ((stale[v] || stale[other_side(v)]) && v <= other_side(v) && slides.of[v] != Slide::none)
        moves[other_side(v)] = moves[v] = best_move(v);
    std::vector<int> moved;
    for (int v = 0; v < static_cast<int>(moves.size()); ++v) {
      if (!moves[v].better() || v > other_side(v)) continue;
      const auto is_first = [&](int node) {
        return std::all_of(beside[node].begin(), beside[node].end(), [&](int other) {
          return !moves[other].better() || moves[v].before <= moves[other].before;
        });
      };
      if (is_first(v) && is_first(other_side(v))) moved.push_back(v);
    }
    if (moved.empty()) return;
    std::fill(stale.begin(), stale.end(), 0);
    const auto move_to = [&](int v, const Vector3d& place) {
      control.outer[v] = place;
      stale[v] = 1;
      for (int other : beside[v]) stale[other] = 1;
      for (int other : slides.around[v])
        if (other >= 0) stale[other] = 1;
    };
    for (int v : moved) {
      if (other_side(v) != v) move_to(other_side(v), moves[v].mirrored);
      move_to(v, moves[v].place);
    }
  }
}

}  // namespace tensegric_fit::control_mesh
