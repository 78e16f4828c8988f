/// A scanned body as a surface to be compared with.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "correlation/border.hpp"
#include "geometry/surface_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::correlation {

/// Nearest places of a scanned body's skin.
class SeenSurface {
 public:
  /// `filled` is empty or has one flag per vertex: 1 where the scan saw nothing. The mesh must outlive it.
  /// \throw Refusal bad_mesh, non_finite; bad_mesh: not one flag per vertex
  SeenSurface(const geometry::TriangleMesh& mesh, std::vector<char> filled);

  struct Place {
    Eigen::Vector3d position;
    Eigen::Vector3d normal;  ///< unit, outwards, smooth over the skin; zero where it has no area
    bool seen;               ///< the scan saw all three corners, and it is not the rim of a hole
  };
  Place nearest(const Eigen::Vector3d& query) const;

 private:
  const geometry::TriangleMesh& mesh_;
  std::vector<char> filled_;
  std::vector<Eigen::Vector3d> normals_;
  geometry::SurfaceTree tree_;
  Border border_;
};

}  // namespace tensegric_fit::correlation
