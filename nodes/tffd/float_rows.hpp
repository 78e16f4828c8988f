/// The fast path of t-FFD: weights and displacements in single precision, positions in double.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tffd/weights.hpp"

namespace tensegric_fit::tffd {

/// The rows of M that are not empty. Displacements are a few centimetres, so single precision is off by some
/// 1e-8 m.
class FloatRows {
 public:
  FloatRows() = default;
  FloatRows(const SparseRows& nodes, const std::vector<Anchor>& anchors);

  /// Adds M times the nodes' motion to the anchors' positions.
  void add(const std::vector<Eigen::Vector3d>& motion, const std::vector<Anchor>& anchors,
           std::vector<Eigen::Vector3d>& positions) const;

 private:
  std::vector<int> starts_;  // of anchor i: entries starts_[i] to starts_[i + 1]
  std::vector<int> columns_;
  std::vector<float> weights_;
};

}  // namespace tensegric_fit::tffd
