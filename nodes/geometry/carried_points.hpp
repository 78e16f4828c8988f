/// Points on the skin that go where the skin goes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/surface_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// Each point keeps its place in the triangle of the mesh at rest that is nearest to it, and its offset from
/// that place.
class CarriedPoints {
 public:
  CarriedPoints() = default;
  /// `skin` is the tree of `rest`. Metres, one frame.
  CarriedPoints(const TriangleMesh& rest, const SurfaceTree& skin,
                const std::vector<Eigen::Vector3d>& points);

  /// Where they are once the mesh's vertices are at `vertices`, `lift` metres above the skin, for what would
  /// sink into it half-way. \pre one per vertex of the mesh at rest
  std::vector<Eigen::Vector3d> at(const std::vector<Eigen::Vector3d>& vertices, double lift = 0) const;

 private:
  struct Place {
    Eigen::Vector3i corners;
    Eigen::Vector3d shares, offset;
  };
  std::vector<Place> places_;
};

}  // namespace tensegric_fit::geometry
