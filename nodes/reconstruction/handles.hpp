/// Handles of a surface: bridges between parts that should be apart.
#pragma once

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// Number of handles: 0 for a sphere, 1 for a ring. \pre closed, in one piece
int genus(const geometry::TriangleMesh& mesh);

/// The surface without its handles: each is cut along a short loop that does not part the surface (Erickson
/// and Whittlesey 2005), and both rims are closed. A loop longer than `longest` is left, since the body
/// itself may be a ring there (hands joined overhead); of a hand on the hip the wrist is cut, which moves no
/// skin. \pre closed, manifold, in one piece
geometry::TriangleMesh without_handles(const geometry::TriangleMesh& mesh, double longest);

}  // namespace tensegric_fit::reconstruction
