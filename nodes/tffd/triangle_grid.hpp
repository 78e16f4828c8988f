/// A uniform grid over space that finds which control triangles a point may be in reach of.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tffd/frame.hpp"

namespace tensegric_fit::tffd {

class TriangleGrid {
 public:
  /// `reach` is in multiples of a triangle's radius. \pre there are frames, all finite
  TriangleGrid(const std::vector<Frame>& frames, double reach);

  struct Range {
    const int *first, *last;
    const int* begin() const { return first; }
    const int* end() const { return last; }
  };

  /// Ascending: every triangle that is not farther_than(reach * radius, q), and some others.
  Range near(const Eigen::Vector3d& q) const;

 private:
  Eigen::Vector3d low_;
  double cell_;
  Eigen::Array3i counts_;
  std::vector<int> starts_;  // of cell i: triangles_[starts_[i]] to triangles_[starts_[i + 1]]
  std::vector<int> triangles_;
};

}  // namespace tensegric_fit::tffd
