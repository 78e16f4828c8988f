/// Inner nodes: the supposed thickness of the soft tissue (P2 §2.1).
#pragma once

#include <vector>

#include "control_mesh/skin.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Puts inner node i `thickness[i]` below outer node i along the control mesh's normal, less where the body
/// is thin there or where an inner triangle would fold or shrink to a sliver.
void place_inner_nodes(geometry::ControlMesh& control, std::vector<double> thickness, const Skin& skin);

/// Brings inner nodes nearer to their outer ones wherever an inner triangle is folded or a sliver.
void thin_folded_units(geometry::ControlMesh& control);

}  // namespace tensegric_fit::control_mesh
