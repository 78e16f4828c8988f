/// From a surface as Poisson leaves it to one closed manifold.
#pragma once

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// The largest connected piece, cut open where it is not manifold and closed again, outward. What is already
/// closed and manifold keeps its vertices and triangles. \throw Refusal not_a_body: there is no surface;
/// bad_mesh: it cannot be closed
geometry::TriangleMesh one_closed_surface(const geometry::TriangleMesh& surface);

}  // namespace tensegric_fit::reconstruction
