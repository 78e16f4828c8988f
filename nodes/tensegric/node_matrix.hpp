/// Symmetric sparse matrices of 3x3 blocks, one block row a free node.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
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
  NodeMatrix(int nodes, std::vector<std::pair<int, int>> pairs);

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
  /// The block at the `rank`th of below(column), or with rank -1 the lower triangle of the one on the
  /// diagonal.
  Eigen::Matrix3d block(int column, int rank) const;
  /// Lower triangle.
  const Eigen::SparseMatrix<double>& lower() const { return lower_; }

 private:
  std::vector<int> start_, rows_;  // of each block column, the block rows below the diagonal
  Eigen::SparseMatrix<double> lower_;
};

}  // namespace tensegric_fit::tensegric
