/// Finer control meshes for the speed-against-error report (README.md).
#pragma once

#include "control_mesh/skin.hpp"
#include "geometry/control_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Each triangle becomes four: new nodes on the skin over the middles of the edges, inner ones halfway
/// between inner nodes. Old nodes keep their numbers. Lines run through the new nodes; the rim stays the rim,
/// with its flags, and what is fixed inside it stays fixed. \pre `control` and `skin` are in the same frame
geometry::ControlMesh subdivide(const geometry::ControlMesh& control, const Skin& skin);

}  // namespace tensegric_fit::control_mesh
