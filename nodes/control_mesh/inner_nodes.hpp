/// Inner nodes: the supposed thickness of the soft tissue (P2 §2.1).
#pragma once

#include <vector>

#include "control_mesh/bone_rule.hpp"
#include "control_mesh/skin.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Puts inner node i `thickness[i]` below outer node i along the control mesh's normal, less where the body
/// is thin there or where an inner triangle would fold or shrink to a sliver. False where some are folded all
/// the same.
bool place_inner_nodes(geometry::ControlMesh& control, std::vector<double> thickness, const Skin& skin);

/// Of each node, m. \pre the control mesh has the rule's node and its mirror image
std::vector<double> thickness_of(const CushionRule& rule, const geometry::ControlMesh& control);

/// Puts the inner nodes on the smooth surface through `inset` below the nodes whose inner ones are held: of
/// all such surfaces the one that bends least (the umbrella operator of its nodes, squared, summed), pressed
/// down where less than `least` would be left. On it they slide until, as far as can be, no unit is nearly
/// turned inside out; the others are thinned. Of the depth they take the rule's share, times `scale`.
void place_on_bone(geometry::ControlMesh& control, const BoneRule& rule, double scale);

/// Brings inner nodes nearer to their outer ones wherever an inner triangle is folded or a sliver. False
/// where one is folded even at 1.5 % of its thickness: its outer one is a needle.
bool thin_folded_units(geometry::ControlMesh& control);

}  // namespace tensegric_fit::control_mesh
