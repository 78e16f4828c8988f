/// What a template says without a body: which nodes there are and how they hang together.
#pragma once

#include <string>
#include <vector>

#include "control_mesh/template.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Her left half is drawn in the template; the right half is its mirror image.
enum class Side { left, right };

/// Template::numbers from the template's cells. \pre `diagonals` is read
std::vector<int> number_nodes(const Template& pattern);

/// Number of the node at a row and a column of the template's drawn half, on either side; -1: no node.
int node_at(const Template& pattern, int row, int column, Side side);

/// `name` as it reads on a side: on her right _L and _R change places; names without a side stay.
std::string name_on(const std::string& name, Side side);

/// The control mesh with names, flags, triangles and regions, but all nodes at the origin. Triangles
/// run counter-clockwise for columns that go from her left over the front.
geometry::ControlMesh grid_of(const Template& pattern);

/// A node's place in words, for refusals.
std::string where_of(const Template& pattern, const TemplateNode& node);

/// What must hold of templates that are worn at once, whatever the body.
/// \throw Refusal bad_template: two have a node, a region or a line of the same name, or one of them with
/// `bone` holds fewer than three inner nodes. Whether enough nodes are held otherwise is for the solver to
/// say: it depends on the tissue
void check_together(const std::vector<Template>& patterns);

}  // namespace tensegric_fit::control_mesh
