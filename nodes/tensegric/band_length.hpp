/// A band's length, and its derivatives by the free nodes (README.md).
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "tensegric/band.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// Length of the polyline.
double length_of(const Band& band, const Positions& x);

/// The same, smooth where a segment is shorter than `band.smooth` (1 mm, less on tiny models),
/// so that it may pass through zero; exact elsewhere.
double smooth_length(const Band& band, const Positions& x);

/// Change of the smooth length by the polyline's own, as its segments grow in proportion.
double smooth_slope(const Band& band, const Positions& x);

/// Adds `scale` times the smooth length's gradient by the free nodes. Returns the smooth length.
double add_length_gradient(const Band& band, const Positions& x, const std::vector<int>& free_index,
                           double scale, Eigen::Ref<Eigen::VectorXd> gradient);

/// The smooth length's second derivative. A point on the body hangs on dozens of nodes, and a band has
/// hundreds of points: what does not change with positions is kept.
class LengthCurvature {
 public:
  /// The band must outlive it.
  LengthCurvature(const Band& band, const std::vector<int>& free_index);

  /// Of free nodes, by their free index: where the second derivative has blocks off the diagonal.
  std::vector<std::pair<int, int>> coupled_nodes() const;

  /// Adds `scale` times the second derivative (positive semi-definite for scale >= 0). \pre the matrix
  /// couples coupled_nodes()
  void add(const Positions& x, double scale, NodeMatrix& hessian) const;

 private:
  // Pairs of its nodes, p >= q, row by row: each row from the first node that p meets. Nodes are numbered
  // along the band, so that rows stay short.
  Eigen::Index pair_of(int p, int q) const { return row_[p] + q; }

  const Band& band_;
  std::vector<int> nodes_;                                  // free index of each node that carries it
  std::vector<std::vector<std::pair<int, double>>> spans_;  // of each segment: place in nodes_, and weight
  std::vector<Eigen::Index> row_;                           // of each place in nodes_: pair_of(p, 0)
  Eigen::Index pairs_ = 0;
  std::vector<std::pair<int, int>> coupled_;  // places in nodes_
};

}  // namespace tensegric_fit::tensegric
