/// How skin is stretched in its own plane.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::inspect {

/// Bound to a mesh at rest; its triangles must stay as they are.
class SkinStretch {
 public:
  explicit SkinStretch(const geometry::TriangleMesh& rest);

  /// One per vertex: mean over the triangles around it, by their areas at rest, of the principal stretch
  /// (length after / before) that is farther from 1. Exactly 1 where nothing around the vertex moved.
  std::vector<double> at(const std::vector<Eigen::Vector3d>& vertices) const;

 private:
  struct Patch {
    Eigen::Vector3i corners;
    Eigen::Matrix2d from_plane;  // edges of the triangle at rest in its plane, inverted
    double area;
  };
  std::vector<Eigen::Vector3d> rest_;
  std::vector<Patch> patches_;
};

}  // namespace tensegric_fit::inspect
