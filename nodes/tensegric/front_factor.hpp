/// Factorisation of symmetric sparse matrices of 3x3 blocks. Eigen's SimplicialLDLT, one entry at a time,
/// takes 24 ms where this takes 9 (1920 control triangles), and 298 ms where it takes 109 (7680).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// Multifrontal L D L^T without pivoting: nodes with the same neighbours to come are eliminated together, in
/// dense matrices (I. S. Duff, J. K. Reid, "The multifrontal solution of indefinite sparse symmetric linear
/// equations", 1983). The order is one of approximately least degree. For matrices that need no pivoting to
/// be solved well.
class FrontFactor {
 public:
  /// The symbolic part, for all matrices of this pattern.
  explicit FrontFactor(const NodeMatrix& pattern);

  /// False where a pivot is zero or not finite. \pre the same pattern
  bool factorise(const NodeMatrix& matrix);

  /// \pre the last factorisation went well
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

  /// Pivots that are not positive: by the law of inertia as many as the matrix has such eigenvalues.
  int negative_pivots() const { return static_cast<int>((pivots_.array() <= 0).count()); }

 private:
  // A block of the matrix, and where it goes in its front.
  struct Source {
    int column, rank, to_row, to_column;
    bool transposed;
  };
  // Nodes `first` to `last` of the order, eliminated together; `rows` are the later ones that they touch.
  struct Front {
    int first, last;
    std::vector<int> rows, children;
    std::vector<Source> sources;
    Eigen::MatrixXd factor;  // columns of L, unit diagonal
    int width() const { return last - first + 1; }
  };

  void find_fronts(const std::vector<std::vector<int>>& columns, const std::vector<int>& parent);
  void place_sources(const NodeMatrix& pattern);
  using Square = Eigen::Map<Eigen::MatrixXd>;
  Square assemble(const Front& front, const NodeMatrix& matrix, std::vector<std::vector<double>>& updates);
  bool eliminate(Front& front, Square& dense);
  std::vector<double> spare(Eigen::Index count);

  std::vector<int> order_, rank_;  // old number by new, new by old
  std::vector<Front> fronts_;      // children before parents
  std::vector<int> local_;         // of each node in the front at hand
  Eigen::VectorXd pivots_;
  // Memory of earlier fronts and factorisations, for the next: nodes give freed memory back to the system at
  // once, and half of a solve went into getting it again.
  std::vector<double> dense_;
  std::vector<std::vector<double>> spare_;
  Eigen::MatrixXd scaled_, below_;
};

}  // namespace tensegric_fit::tensegric
