/// Decimation and refinement of a mesh to a number of triangles.
#pragma once

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// The same surface with `triangles` triangles, or one less: edges are collapsed by quadric error (Garland
/// and Heckbert 1997) without turning a triangle over, or the longest edges are split. A closed mesh stays
/// closed, and each piece keeps its holes. More triangles are left where no edge can be collapsed any more.
/// \pre the mesh has passed check_mesh and is not empty. \throw Refusal bad_mesh: a non-manifold edge or
/// vertex
TriangleMesh with_triangles(const TriangleMesh& mesh, int triangles);

/// The same surface with at most `triangles` triangles: the longest edges between two heights (z, m) are
/// split. \pre and \throw as above
TriangleMesh with_finer_belt(const TriangleMesh& mesh, int triangles, double lowest, double highest);

/// Collapses edges shorter than `shortest`, metres, where that turns no triangle over: an isosurface of grid
/// cells has slivers. No vertex moves farther than `shortest`. A closed mesh stays closed. \pre and \throw as
/// above
TriangleMesh without_short_edges(const TriangleMesh& mesh, double shortest);

}  // namespace tensegric_fit::geometry
