#include "tensegric/node_matrix.hpp"

#include <algorithm>

namespace tensegric_fit::tensegric {

NodeMatrix::NodeMatrix(int nodes, std::vector<std::pair<int, int>> pairs) : lower_(3 * nodes, 3 * nodes) {
  for (auto& pair : pairs)
    if (pair.first > pair.second) std::swap(pair.first, pair.second);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  start_.assign(1, 0);
  std::size_t next = 0;
  for (int column = 0; column < nodes; ++column) {
    for (; next < pairs.size() && pairs[next].first == column; ++next) rows_.push_back(pairs[next].second);
    start_.push_back(static_cast<int>(rows_.size()));
  }

  lower_.reserve(6 * nodes + 9 * static_cast<Eigen::Index>(rows_.size()));
  for (int column = 0; column < nodes; ++column) {
    for (int j = 0; j < 3; ++j) {
      lower_.startVec(3 * column + j);
      for (int i = j; i < 3; ++i) lower_.insertBack(3 * column + i, 3 * column + j) = 0;
      for (int k = start_[column]; k < start_[column + 1]; ++k)
        for (int i = 0; i < 3; ++i) lower_.insertBack(3 * rows_[k] + i, 3 * column + j) = 0;
    }
  }
  lower_.finalize();
}

void NodeMatrix::clear() {
  std::fill_n(lower_.valuePtr(), lower_.nonZeros(), 0.0);
}

void NodeMatrix::add(int row, int column, const Eigen::Matrix3d& block) {
  if (row < 0 || column < 0) return;
  if (row < column) return add(column, row, block.transpose());
  double* values = lower_.valuePtr();
  const int* columns = lower_.outerIndexPtr();
  if (row == column) {
    for (int j = 0; j < 3; ++j)
      for (int i = j; i < 3; ++i) values[columns[3 * column + j] + i - j] += block(i, j);
    return;
  }
  const auto first = rows_.begin() + start_[column], last = rows_.begin() + start_[column + 1];
  const int rank = static_cast<int>(std::lower_bound(first, last, row) - first);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) values[columns[3 * column + j] + (3 - j) + 3 * rank + i] += block(i, j);
}

void NodeMatrix::add_outer(const std::vector<int>& nodes, const std::vector<Eigen::Vector3d>& at_nodes,
                           double factor) {
  double* values = lower_.valuePtr();
  const int* columns = lower_.outerIndexPtr();
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    const int column = nodes[b];
    const Eigen::Vector3d by_column = factor * at_nodes[b];
    for (int j = 0; j < 3; ++j)
      for (int i = j; i < 3; ++i) values[columns[3 * column + j] + i - j] += at_nodes[b][i] * by_column[j];
    auto row = rows_.begin() + start_[column];
    const auto first = row, last = rows_.begin() + start_[column + 1];
    for (std::size_t a = b + 1; a < nodes.size(); ++a) {
      row = std::lower_bound(row, last, nodes[a]);
      const int rank = static_cast<int>(row - first);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          values[columns[3 * column + j] + (3 - j) + 3 * rank + i] += at_nodes[a][i] * by_column[j];
    }
  }
}

Eigen::Matrix3d NodeMatrix::block(int column, int rank) const {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double* values = lower_.valuePtr() + lower_.outerIndexPtr()[3 * column + j];
    for (int i = rank < 0 ? j : 0; i < 3; ++i) result(i, j) = values[rank < 0 ? i - j : 3 - j + 3 * rank + i];
  }
  return result;
}

void NodeMatrix::add_to_diagonal(double value) {
  for (int j = 0; j < lower_.cols(); ++j) lower_.valuePtr()[lower_.outerIndexPtr()[j]] += value;
}

}  // namespace tensegric_fit::tensegric
