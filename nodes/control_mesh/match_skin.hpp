/// Makes a control mesh hold as much as the body below it.
#pragma once

#include <vector>

#include "control_mesh/skin.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Flat triangles between nodes on the skin cut off what bulges between them: 3 to 4 % of the volume with 120
/// triangles. Moves the nodes with `may_move` along their normals by the mean gap between triangles and skin
/// round each, 3 mm at most; where that is not enough, the others by what is missing to the whole.
void match_skin(geometry::ControlMesh& control, const std::vector<char>& may_move, const Skin& skin);

}  // namespace tensegric_fit::control_mesh
