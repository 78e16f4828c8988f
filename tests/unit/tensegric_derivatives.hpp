/// Derivatives of an energy of a model's units against differences of it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

using NodePairs = std::vector<std::pair<int, int>>;

/// Of all nodes of each unit; those that are not free are left out.
template <typename Unit>
NodePairs pairs_within(const std::vector<Unit>& units, const std::vector<int>& free_index) {
  NodePairs pairs;
  for (const Unit& unit : units)
    for (int i = 0; i < static_cast<int>(unit.nodes.size()); ++i)
      for (int j = 0; j < i; ++j)
        if (free_index[unit.nodes[i]] >= 0 && free_index[unit.nodes[j]] >= 0)
          pairs.emplace_back(free_index[unit.nodes[i]], free_index[unit.nodes[j]]);
  return pairs;
}

/// Along a random direction, near rest. `energy(units, x)`, `add_gradient(units, x, free_index, gradient)`
/// and `add_hessian(units, x, free_index, hessian)`, whose blocks are at `pairs`.
template <typename Units, typename Energy, typename AddGradient, typename AddHessian>
void expect_derivatives(const Model& model, const Units& units, const NodePairs& pairs, const Energy& energy,
                        const AddGradient& add_gradient, const AddHessian& add_hessian) {
  const std::vector<int> free_index = model.free_index();
  const unsigned seed = std::random_device{}();
  const testing::ScopedTrace trace{__FILE__, __LINE__, "seed " + std::to_string(seed)};
  std::mt19937 random{seed};
  std::normal_distribution<double> normal(0, 1);
  const int rows = 3 * model.free_nodes();
  const Eigen::VectorXd direction =
      Eigen::VectorXd::NullaryExpr(rows, [&](Eigen::Index) { return normal(random); });
  Positions x = model.rest_positions();
  const auto moved = [&](double step) {
    Positions y = x;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (free_index[i] >= 0) y[i] += step * direction.segment<3>(3 * free_index[i]);
    return y;
  };
  x = moved(0.003);
  const auto gradient = [&](const Positions& y) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(rows);
    add_gradient(units, y, free_index, g);
    return g;
  };
  constexpr double kStep = 1e-6;  // m; the third derivative and rounding then stay below 1e-7 of the result
  const double slope = (energy(units, moved(kStep)) - energy(units, moved(-kStep))) / (2 * kStep);
  EXPECT_NEAR(gradient(x).dot(direction), slope, 1e-6 * std::abs(slope));
  NodeMatrix hessian(model.free_nodes(), pairs);
  add_hessian(units, x, free_index, hessian);
  const Eigen::VectorXd change = (gradient(moved(kStep)) - gradient(moved(-kStep))) / (2 * kStep);
  const Eigen::VectorXd product = hessian.lower().selfadjointView<Eigen::Lower>() * direction;
  EXPECT_LE((change - product).norm(), 1e-6 * change.norm());
}

}  // namespace tensegric_fit::tensegric
