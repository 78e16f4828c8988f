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

/// Exact for triangles of any size: they are kept by size, and a triangle is left out only where its centroid
/// is too far away for one of its size.
class SurfaceTree {
 public:
  /// `mesh` must outlive it. \pre it has triangles and has passed check_mesh
  explicit SurfaceTree(const TriangleMesh& mesh);

  /// Of points that are equally near the one whose triangle's centroid is nearer.
  SurfacePoint nearest(const Eigen::Vector3d& query) const;

 private:
  /// Triangles of like size.
  struct Size {
    double reach;  ///< m, from a centroid to the farthest corner, at most
    std::vector<int> triangles;
    PointTree centroids;
  };

  const TriangleMesh& mesh_;
  std::vector<Size> sizes_;
};

}  // namespace tensegric_fit::geometry
