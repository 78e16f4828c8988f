/// A sparse grid of cubes over points: neighbourhoods by cell, without a search tree.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Cells are kept in ascending order of (z, y, x); each holds the indices of its points in ascending order.
class VoxelGrid {
 public:
  /// \pre not empty, all finite, at most 2^20 cells along an axis
  VoxelGrid(const std::vector<Eigen::Vector3d>& points, double cell_size);

  int cell_count() const { return static_cast<int>(keys_.size()); }
  /// Point indices of cell c: order()[begin(c)] to order()[end(c) - 1].
  int begin(int cell) const { return first_[cell]; }
  int end(int cell) const { return first_[cell + 1]; }
  const std::vector<int>& order() const { return order_; }
  /// The occupied cells among the 27 around and including `cell`, ascending.
  void around(int cell, std::vector<int>& cells) const;

 private:
  std::vector<std::int64_t> keys_;
  std::vector<int> first_, order_;
  std::int64_t row_, layer_;
};

}  // namespace tensegric_fit::reconstruction
