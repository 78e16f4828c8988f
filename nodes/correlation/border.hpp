/// Where a surface ends.
#pragma once

#include <array>
#include <vector>

#include "geometry/surface_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::correlation {

/// The vertices and edges of an open mesh that have triangles on one side only. The mesh must outlive it.
class Border {
 public:
  explicit Border(const geometry::TriangleMesh& mesh);

  /// Whether a place of the mesh lies on it, as the nearest place to a point that is not above the surface
  /// does.
  bool holds(const geometry::SurfacePoint& place) const;

 private:
  const geometry::TriangleMesh& mesh_;
  std::vector<char> vertex_;
  std::vector<std::array<int, 2>> edges_;  // ascending, as edges_of gives them
};

}  // namespace tensegric_fit::correlation
