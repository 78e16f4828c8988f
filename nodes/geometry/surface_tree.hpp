/// Nearest points of a dense surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/point_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// A point of a mesh's surface.
struct SurfacePoint {
  int triangle;
  Eigen::Vector3d barycentric;  ///< of the triangle's corners in order; none negative, sum 1
  Eigen::Vector3d position;     ///< m
};

/// Answers are exact where triangles are of like size: only those with the nearest centroids are looked at.
class SurfaceTree {
 public:
  /// `mesh` must outlive it. \pre it has triangles and has passed check_mesh
  explicit SurfaceTree(const TriangleMesh& mesh);

  SurfacePoint nearest(const Eigen::Vector3d& query) const;

 private:
  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> centroids_;
  PointTree tree_;
};

}  // namespace tensegric_fit::geometry
