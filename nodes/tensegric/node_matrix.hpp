/// Symmetric sparse matrices of 3x3 blocks, one block row a free node.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <utility>
#include <vector>

namespace tensegric_fit::tensegric {

/// cross_matrix(v) * w = v x w
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The pattern stands from the start; values are cleared and added to as often as wanted, so that a
/// factorisation's symbolic part is done once.
class NodeMatrix {
 public:
  /// Blocks on the diagonal and at each of `pairs` of nodes, in any order, repeated or not.
  NodeMatrix(int nodes, const std::vector<std::pair<int, int>>& pairs);

  void clear();
  /// Adds `block` at (row, column) and, off the diagonal, its transpose at (column, row). A negative index (a
  /// fixed node) adds nothing. \pre the pair is in the pattern
  void add(int row, int column, const Eigen::Matrix3d& block);
  /// Adds factor v v^T, where v has `at_nodes` at `nodes`, which ascend. \pre all pairs are in the pattern
  void add_outer(const std::vector<int>& nodes, const std::vector<Eigen::Vector3d>& at_nodes, double factor);
  void add_to_diagonal(double value);
  int nodes() const { return static_cast<int>(start_.size()) - 1; }
  /// The nodes below the diagonal in a block column, ascending.
  std::vector<int> below(int column) const {
    return {rows_.begin() + start_[column], rows_.begin() + start_[column + 1]};
  }
  /// The block at the `rank`th of below(column), or with rank -1 the one on the diagonal.
  Eigen::Map<const Eigen::Matrix3d> block(int column, int rank) const {
    return Eigen::Map<const Eigen::Matrix3d>(values_.data() + place(column, rank));
  }
  /// Lower triangle.
  Eigen::SparseMatrix<double> lower() const;

 private:
  // Of a block's nine values, column by column: a block column's first is on the diagonal.
  std::size_t place(int column, int rank) const {
    return 9 * static_cast<std::size_t>(start_[column] + column + 1 + rank);
  }
  Eigen::Map<Eigen::Matrix3d> block_at(int column, int rank) {
    return Eigen::Map<Eigen::Matrix3d>(values_.data() + place(column, rank));
  }

  std::vector<int> start_, rows_;  // of each block column, the block rows below the diagonal
  std::vector<double> values_;
};

}  // namespace tensegric_fit::tensegric
