/// Implicit shape -> closed triangle mesh.
#pragma once

#include "geometry/triangle_mesh.hpp"
#include "virtual_body/implicit.hpp"

namespace tensegric_fit::virtual_body {

/// Marching cubes on a grid of `spacing` metres, vertices moved onto the skin. Each half of the body (split
/// at y = 0) is made in the left half's coordinates, so that a symmetric shape gives a mesh that is its own
/// mirror image. \throw Refusal bad_mesh: the result is not closed
geometry::TriangleMesh polygonise(const Implicit& shape, double spacing);

}  // namespace tensegric_fit::virtual_body
