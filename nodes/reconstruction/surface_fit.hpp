/// Moves a surface onto the points that it was made from.
#pragma once

#include "geometry/point_cloud.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// Moves each vertex along its normal onto the implicit moving least squares surface of the points around it
/// that face its way (Kolluri 2008): Poisson's cells are coarser than the points are dense, and round off
/// fingers and folds. Vertices without points near them stay. \param tree of
/// the cloud's points \pre unit normals in `cloud`, not empty
void fit_to_points(geometry::TriangleMesh& mesh, const geometry::PointCloud& cloud,
                   const geometry::PointTree& tree);

}  // namespace tensegric_fit::reconstruction
