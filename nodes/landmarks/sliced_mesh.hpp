/// A mesh cut into slabs once, so that each of many horizontal sections looks at a few triangles only.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "landmarks/outline.hpp"

namespace tensegric_fit::landmarks {

class SlicedMesh {
 public:
  /// \pre the mesh has vertices
  explicit SlicedMesh(const geometry::TriangleMesh& mesh);

  /// Material cut at a height, largest area first.
  std::vector<Outline> outlines_at(double height) const;

  double bottom() const { return bottom_; }
  double top() const { return top_; }

 private:
  int slab_of(double height) const;

  double bottom_, top_;
  std::vector<geometry::TriangleMesh> slabs_;  // each has every triangle that reaches into it
};

}  // namespace tensegric_fit::landmarks
