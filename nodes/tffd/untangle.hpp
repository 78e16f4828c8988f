/// Skin triangles that a motion would turn over.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "tffd/reach.hpp"

namespace tensegric_fit::tffd {

/// A needle of a scanned mesh, a fifth as high as long or less, turns over where its corners follow the
/// control mesh by hardly different weights: its widest corner is then put back where the side opposite to it
/// carries it.
class Untangle {
 public:
  Untangle() = default;  ///< watches nothing
  /// Watches the body's needles whose widest corner is an anchor: other vertices stay where they are.
  Untangle(const geometry::TriangleMesh& body, const std::vector<Anchor>& anchors);

  /// Moves corners of needles that face against themselves in `rest` where the skin beside them does not;
  /// nothing where there are none. A few rounds at most, in a fixed order.
  void operator()(const std::vector<Eigen::Vector3d>& rest, std::vector<Eigen::Vector3d>& moved) const;

 private:
  struct Needle {
    Eigen::Vector3i corners;              // the widest first
    std::vector<Eigen::Vector3i> beside;  // the triangles that share a side with it, and it itself
  };
  std::vector<Needle> needles_;
};

}  // namespace tensegric_fit::tffd
