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

/// Triangles that face against the skin below them, or nearly across it.
int count_turned(const geometry::ControlMesh& control, const Skin& skin);

/// How a node may slide over the skin. Those of the mid-plane stay on it.
enum class Slide : char { none, along_column, either_way };

/// Where a triangle is turned, or nearly: slides nodes along the skin between their upper and lower or their
/// left and right neighbours, those that there are, to where their triangles lie best on it. Half way may be
/// inside a fold. Of neighbours that would move the worse goes first, so that no order shows.
void turn_back(geometry::ControlMesh& control, const std::vector<Slide>& slides,
               const std::vector<GridNeighbours>& around, const Skin& skin);

}  // namespace tensegric_fit::control_mesh
