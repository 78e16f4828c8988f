#include "tensegric/prestress.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/status.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kMostSteps = 60;
// Largest net force at a free node: aimed at, over the largest ideal force of a part; and what is a balance
// where it falls no more, over the largest force of a part: sums over thousands of parts round by some 1e-13.
constexpr double kTolerance = 1e-13, kRoundOff = 1e-11;

// Nearest point w to the ideal (+-1, in multiples of each part's ideal density) with C w = 0 and w within its
// bounds, by Newton steps on the dual: w = clamp(ideal + C^T y), and the dual's gradient is C w.
class NearestBalance {
 public:
  NearestBalance(const Model& model, const std::vector<double>& ideal)
      : model_(model), free_(model.free_index()), matrix_(model.free_nodes(), pairs()), density_(ideal) {
    const Positions rest = model.rest_positions();
    double mean = 0;
    for (const Member& m : model.members) mean += m.rest / model.members.size();
    for (std::size_t i = 0; i < model.members.size(); ++i) {
      const Member& m = model.members[i];
      ideal_.push_back(m.strut ? -1 : 1);
      column_.push_back(density_[i] / mean * (rest[m.a] - rest[m.b]));
      largest_ = std::max(largest_, column_.back().norm());
    }
  }

  // Densities with tensile parts at `lowest` of their ideal or more; empty where there are none.
  Eigen::VectorXd densities(double lowest) {
    const int rows = 3 * model_.free_nodes();
    Eigen::VectorXd y = Eigen::VectorXd::Zero(rows);
    std::vector<double> w = clamped(y, lowest);
    Eigen::VectorXd force = net_force(w);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
    factor.analyzePattern(matrix_.lower());
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostSteps && imbalance(force) > kTolerance; ++step) {
      if (is_rounding(force, w) && imbalance(force) >= before) break;
      before = imbalance(force);
      fill(y, lowest);
      factor.factorize(matrix_.lower());
      if (factor.info() != Eigen::Success) return {};
      const Eigen::VectorXd dy = factor.solve(-force);
      const double slope = force.dot(dy), start = objective(y, w, force);
      double length = 1;
      for (int halving = 0; halving < 30; ++halving, length /= 2) {
        const Eigen::VectorXd trial = y + length * dy;
        w = clamped(trial, lowest);
        force = net_force(w);
        if (objective(trial, w, force) <= start + 1e-4 * length * slope + 1e-14 * std::abs(start)) break;
      }
      y += length * dy;
    }
    if (imbalance(force) > kTolerance && !is_rounding(force, w)) return {};
    Eigen::VectorXd density(w.size());
    for (std::size_t i = 0; i < w.size(); ++i) density[i] = w[i] * density_[i];
    return density;
  }

 private:
  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> list;
    for (const Member& m : model_.members)
      if (free_[m.a] >= 0 && free_[m.b] >= 0) list.emplace_back(free_[m.a], free_[m.b]);
    return list;
  }

  double unclamped(const Eigen::VectorXd& y, std::size_t i) const {
    const int a = free_[model_.members[i].a], b = free_[model_.members[i].b];
    double value = ideal_[i];
    if (a >= 0) value += column_[i].dot(y.segment<3>(3 * a));
    if (b >= 0) value -= column_[i].dot(y.segment<3>(3 * b));
    return value;
  }

  bool in_bounds(double value, std::size_t i, double lowest) const {
    return model_.members[i].strut ? value <= 0 : value >= lowest;
  }

  std::vector<double> clamped(const Eigen::VectorXd& y, double lowest) const {
    std::vector<double> w(ideal_.size());
    for (std::size_t i = 0; i < w.size(); ++i) {
      const double value = unclamped(y, i);
      w[i] = in_bounds(value, i, lowest) ? value : model_.members[i].strut ? 0 : lowest;
    }
    return w;
  }

  Eigen::VectorXd net_force(const std::vector<double>& w) const {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * model_.free_nodes());
    for (std::size_t i = 0; i < w.size(); ++i) {
      const int a = free_[model_.members[i].a], b = free_[model_.members[i].b];
      if (a >= 0) force.segment<3>(3 * a) += w[i] * column_[i];
      if (b >= 0) force.segment<3>(3 * b) -= w[i] * column_[i];
    }
    return force;
  }

  // The dual, turned round so that it is to be made small.
  double objective(const Eigen::VectorXd& y, const std::vector<double>& w,
                   const Eigen::VectorXd& force) const {
    double distance = 0;
    for (std::size_t i = 0; i < w.size(); ++i) distance += (w[i] - ideal_[i]) * (w[i] - ideal_[i]);
    return y.dot(force) - distance / 2;
  }

  void fill(const Eigen::VectorXd& y, double lowest) {
    matrix_.clear();
    for (std::size_t i = 0; i < ideal_.size(); ++i) {
      if (!in_bounds(unclamped(y, i), i, lowest)) continue;
      const int a = free_[model_.members[i].a], b = free_[model_.members[i].b];
      const Eigen::Matrix3d block = column_[i] * column_[i].transpose();
      matrix_.add(a, a, block);
      matrix_.add(b, b, block);
      matrix_.add(a, b, -block);
    }
    matrix_.add_to_diagonal(1e-9);  // a motion that no part resists needs no force either
  }

  double imbalance(const Eigen::VectorXd& force) const { return force.lpNorm<Eigen::Infinity>() / largest_; }

  bool is_rounding(const Eigen::VectorXd& force, const std::vector<double>& w) const {
    double largest = 0;
    for (std::size_t i = 0; i < w.size(); ++i)
      largest = std::max(largest, std::abs(w[i]) * column_[i].norm());
    return force.lpNorm<Eigen::Infinity>() <= kRoundOff * largest;
  }

  const Model& model_;
  std::vector<int> free_;
  NodeMatrix matrix_;
  std::vector<double> ideal_, density_;
  std::vector<Eigen::Vector3d> column_;
  double largest_ = 0;  // force of a part at its ideal density
};

}  // namespace

Eigen::VectorXd force_densities(const Model& model, const std::vector<double>& ideal) {
  NearestBalance balance(model, ideal);
  for (double lowest : {0.1, 0.01, 0.001, 0.0}) {
    const Eigen::VectorXd density = balance.densities(lowest);
    if (density.size() > 0) return density;
  }
  throw geometry::Refusal(
      geometry::refusal::kBadMesh,
      "the control mesh has no prestress that keeps every tensile part taut: its inner nodes may lie "
      "outside, or its triangles be too uneven");
}

}  // namespace tensegric_fit::tensegric
