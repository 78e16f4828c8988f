/// The number of triangles of a mesh.
#pragma once

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// The same surface with `triangles` triangles, or one less: edges are collapsed by quadric error (Garland
/// and Heckbert 1997) without turning a triangle over, or the longest are split. What was closed stays so,
/// and each piece keeps its holes. Keeps more triangles where no edge can be collapsed any more. \pre the
/// mesh has passed check_mesh and is not empty. \throw Refusal bad_mesh: an edge or a vertex in which sheets
/// meet
TriangleMesh with_triangles(const TriangleMesh& mesh, int triangles);

/// The same with triangles of more even size and shape, a little farther from the surface: what a tensegric
/// model stands on.
TriangleMesh with_even_triangles(const TriangleMesh& mesh, int triangles);

/// The same surface with up to so many triangles: the longest edges between two heights (z) are split. \pre
/// and \throw as above
TriangleMesh with_finer_belt(const TriangleMesh& mesh, int triangles, double lowest, double highest);

/// Most edges shorter than `shortest`, metres, are collapsed, where that turns no triangle over: a surface
/// from cells has slivers. No vertex moves farther than that. What was closed stays so. \pre and \throw as
/// above
TriangleMesh without_short_edges(const TriangleMesh& mesh, double shortest);

}  // namespace tensegric_fit::geometry
