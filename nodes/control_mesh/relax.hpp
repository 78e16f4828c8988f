/// Evens out a control mesh on the skin.
#pragma once

#include <vector>

#include "control_mesh/skin.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Moves the nodes with `may_move` over the skin towards the mean of the nodes that `around` gives them
/// (their grid neighbours: diagonals must not pull), all at once each round, so that no order shows.
void relax_on_skin(geometry::ControlMesh& control, const std::vector<char>& may_move,
                   const std::vector<std::vector<int>>& around, const Skin& skin);

/// Triangles that face against the skin below them.
int count_turned(const geometry::ControlMesh& control, const Skin& skin);

/// Where a triangle is turned: moves nodes with `may_move` along the skin between their upper and lower or
/// their left and right neighbours to where their triangles lie best on it. Half way may be inside a fold.
/// \pre the nodes that may move have four in `around`, in that order
void turn_back(geometry::ControlMesh& control, const std::vector<char>& may_move,
               const std::vector<std::vector<int>>& around, const Skin& skin);

}  // namespace tensegric_fit::control_mesh
