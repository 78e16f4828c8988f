/// Normals to draw a mesh with.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::geometry {

/// Vertex normals, unit, each averaged once with those of the triangles about it: noise of a vertex is not
/// shaded, a fold stays (a triangle counts by the eighth power of the cosine between). On a scan of the
/// virtual booth (seed 7) they are nearer to the true skin's in the median (2.4 degrees on the trunk, 2.7
/// before); averaged more often they leave it at the folds.
std::vector<Eigen::Vector3d> shading_normals(const std::vector<Eigen::Vector3d>& vertices,
                                             const std::vector<Eigen::Vector3i>& triangles);

}  // namespace tensegric_fit::geometry
