/// The number of triangles of a mesh.
#pragma once

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// The same surface with `triangles` triangles, or one less: edges are collapsed by quadric error (Garland
/// and Heckbert 1997) without turning a triangle over, or the longest are split. \pre closed and manifold; it
/// stays so. Keeps more triangles where no edge can be collapsed any more.
geometry::TriangleMesh with_triangles(const geometry::TriangleMesh& mesh, int triangles);

}  // namespace tensegric_fit::reconstruction
