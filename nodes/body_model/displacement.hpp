/// What pose and shape leave over: a smooth field of displacements of the model's skin.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "body_model/matching.hpp"
#include "body_model/posed_model.hpp"

namespace tensegric_fit::body_model {

/// The fit points as nodes of a field over the skin: neighbours, areas, and what each vertex takes of whom.
class SkinField {
 public:
  explicit SkinField(const Model& model);

  std::size_t nodes() const { return area_.size(); }
  /// Precision, 1/m^2, of each coordinate of a random field on the nodes with that standard deviation (m)
  /// whose values are independent some `range` (m) apart (Matern field; Lindgren, Rue and Lindstroem 2011,
  /// eq. 10).
  Eigen::SparseMatrix<double> precision(double deviation, double range) const;
  /// One value per vertex of the skin from one per node.
  template <typename Value>
  std::vector<Value> spread(const std::vector<Value>& at_nodes, const Value& zero = {}) const {
    std::vector<Value> result(shares_.size(), zero);
    for (std::size_t v = 0; v < shares_.size(); ++v)
      for (const auto& [n, w] : shares_[v]) result[v] += w * at_nodes[n];
    return result;
  }

 private:
  std::vector<double> area_;                     ///< m^2, of the skin at rest that is nearest to a node
  std::vector<std::pair<int, int>> neighbours_;  ///< nodes whose areas meet, first < second
  std::vector<std::vector<std::pair<int, double>>> shares_;  ///< of each vertex: node, share
};

struct Displaced {
  std::vector<Eigen::Vector3d> vertices;  ///< of the skin, m, scan frame
  std::vector<double> distances;  ///< m, of each node from the samples; Matching::kUnmatched: none there
};

/// The posed skin moved onto the samples.
Displaced displace(const Model& model, const SkinField& field, const Matcher& matcher,
                   const Parameters& parameters);

}  // namespace tensegric_fit::body_model
