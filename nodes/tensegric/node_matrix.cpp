#include "tensegric/node_matrix.hpp"

#include <algorithm>

namespace tensegric_fit::tensegric {

NodeMatrix::NodeMatrix(int nodes, const std::vector<std::pair<int, int>>& pairs) : start_(1, 0) {
  std::vector<std::vector<int>> below(nodes);
  for (const auto& [a, b] : pairs)
    if (a != b) below[std::min(a, b)].push_back(std::max(a, b));
  std::vector<int> seen_in(nodes, -1);
  for (int column = 0; column < nodes; ++column) {
    for (const int row : below[column]) {
      if (seen_in[row] == column) continue;
      seen_in[row] = column;
      rows_.push_back(row);
    }
    std::sort(rows_.begin() + start_.back(), rows_.end());
    start_.push_back(static_cast<int>(rows_.size()));
  }
  values_.assign(9 * (rows_.size() + nodes), 0.0);
}

void NodeMatrix::clear() {
  std::fill(values_.begin(), values_.end(), 0.0);
}

void NodeMatrix::add(int row, int column, const Eigen::Matrix3d& block) {
  if (row < 0 || column < 0) return;
  if (row < column) return add(column, row, block.transpose());
  if (row == column) {
    block_at(column, -1) += block;
    return;
  }
  const auto first = rows_.begin() + start_[column], last = rows_.begin() + start_[column + 1];
  block_at(column, static_cast<int>(std::lower_bound(first, last, row) - first)) += block;
}

void NodeMatrix::add_outer(const std::vector<int>& nodes, const std::vector<Eigen::Vector3d>& at_nodes,
                           double factor) {
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    const int column = nodes[b];
    const Eigen::Vector3d by_column = factor * at_nodes[b];
    block_at(column, -1) += at_nodes[b] * by_column.transpose();
    auto row = rows_.begin() + start_[column];
    const auto first = row, last = rows_.begin() + start_[column + 1];
    for (std::size_t a = b + 1; a < nodes.size(); ++a) {
      row = std::lower_bound(row, last, nodes[a]);
      block_at(column, static_cast<int>(row - first)) += at_nodes[a] * by_column.transpose();
    }
  }
}

void NodeMatrix::add_to_diagonal(double value) {
  for (int column = 0; column < nodes(); ++column) block_at(column, -1).diagonal().array() += value;
}

Eigen::SparseMatrix<double> NodeMatrix::lower() const {
  Eigen::SparseMatrix<double> lower(3 * nodes(), 3 * nodes());
  lower.reserve(6 * nodes() + 9 * static_cast<Eigen::Index>(rows_.size()));
  for (int column = 0; column < nodes(); ++column)
    for (int j = 0; j < 3; ++j) {
      lower.startVec(3 * column + j);
      for (int i = j; i < 3; ++i) lower.insertBack(3 * column + i, 3 * column + j) = block(column, -1)(i, j);
      for (int k = start_[column]; k < start_[column + 1]; ++k)
        for (int i = 0; i < 3; ++i)
          lower.insertBack(3 * rows_[k] + i, 3 * column + j) = block(column, k - start_[column])(i, j);
    }
  lower.finalize();
  return lower;
}

}  // namespace tensegric_fit::tensegric
