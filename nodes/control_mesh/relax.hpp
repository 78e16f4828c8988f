/// Evens out a control mesh on the skin.
#pragma once

#include <array>
#include <vector>

#include "control_mesh/skin.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Nodes beside a node in the grid: above, below, to her left, to her right; -1 where the grid ends.
using GridNeighbours = std::array<int, 4>;

/// Moves the nodes with `may_move` over the skin towards the mean of their grid neighbours (diagonals must
/// not pull), all at once each round, so that no order shows. \pre these have all four
void relax_on_skin(geometry::ControlMesh& control, const std::vector<char>& may_move,
                   const std::vector<GridNeighbours>& around, const Skin& skin);

/// Triangles that lie badly: their normals more than 78 degrees off the skin's below them, or with a corner
/// under 11.5 degrees.
struct Badly {
  int turned = 0, sharp = 0;
  bool none() const { return turned == 0 && sharp == 0; }
  bool operator<(const Badly& other) const {
    return turned != other.turned ? turned < other.turned : sharp < other.sharp;
  }
};
Badly count_badly_laid(const geometry::ControlMesh& control, const Skin& skin);

/// How a node may slide over the skin. Those of the mid-plane stay on it.
enum class Slide : char { none, along_column, either_way };

/// How nodes may be moved.
struct Slides {
  std::vector<Slide> of;               ///< one per node
  std::vector<GridNeighbours> around;  ///< one per node
  /// Of each node the one on her other side, which moves alike; a node itself on the middle column. Empty:
  /// each moves for itself. \pre they are no neighbours
  std::vector<int> mirrored{};
};

/// Where a triangle lies badly: slides nodes along the skin between their upper and lower or their left and
/// right neighbours, those that there are, or moves them to their places in `elsewhere` (the same nodes, laid
/// in other ways), to where their triangles lie best. Half way may be inside a fold. Of neighbours that would
/// move the worse goes first, so that no order shows: but of two sides that are nearly alike it may be
/// either, unless they move together.
void turn_back(geometry::ControlMesh& control, const Slides& slides, const Skin& skin,
               const std::vector<std::vector<Eigen::Vector3d>>& elsewhere = {});

}  // namespace tensegric_fit::control_mesh
