/// A mesh as a scan: points spread over its surface.
#pragma once

#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

inline constexpr int kSamples = 200'000;  // a booth's scan has as many

/// `count` points spread evenly over the mesh's area, whatever its triangles' sizes; the same for the same
/// mesh, in any unit and axes. With outward unit normals where they can be known: triangles are turned to run
/// as their neighbours across edges of two do, pieces by their volume. Else, and of surfaces with one side
/// only, without: the reconstruction finds them. Triangles with a corner that is not finite are left out, and
/// all but one of those in one place. \throw Refusal
/// bad_mesh: no area, or a vertex that is not there
geometry::PointCloud surface_samples(const geometry::TriangleMesh& mesh, int count = kSamples);

}  // namespace tensegric_fit::mesh_files
