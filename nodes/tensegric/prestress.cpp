#include "tensegric/prestress.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  // Of the parts of one piece of the control mesh.
  NearestBalance(const Model& model, std::vector<Member> parts, std::vector<double> ideal)
      : members_(std::move(parts)),
        free_(free_in(model, members_)),
        free_nodes_(1 + *std::max_element(free_.begin(), free_.end())),
        matrix_(free_nodes_, pairs()),
        density_(std::move(ideal)) {
    const Positions rest = model.rest_positions();
    double mean = 0;
    for (const Member& m : members_) mean += m.rest / members_.size();
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Member& m = members_[i];
      ideal_.push_back(m.strut ? -1 : 1);
      column_.push_back(density_[i] / mean * (rest[m.a] - rest[m.b]));
      largest_ = std::max(largest_, column_.back().norm());
    }
  }

  // Densities with tensile parts at `lowest` of their ideal or more; empty where there are none.
  Eigen::VectorXd densities(double lowest) {
    const int rows = 3 * free_nodes_;
    Eigen::VectorXd y = Eigen::VectorXd::Zero(rows);
    std::vector<double> w = clamped(y, lowest);
    Eigen::VectorXd force = net_force(w);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
    if (rows > 0) factor.analyzePattern(matrix_.lower());
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
  // Numbers the free nodes that the parts join.
  static std::vector<int> free_in(const Model& model, const std::vector<Member>& parts) {
    std::vector<int> index(model.nodes(), -1);
    for (const Member& m : parts)
      for (const int node : {m.a, m.b})
        if (!model.is_fixed(node)) index[node] = 0;
    int next = 0;
    for (int& number : index)
      if (number == 0) number = next++;
    return index;
  }

  std::vector<std::pair<int, int>> pairs() const {
    std::vector<std::pair<int, int>> list;
    for (const Member& m : members_)
      if (free_[m.a] >= 0 && free_[m.b] >= 0) list.emplace_back(free_[m.a], free_[m.b]);
    return list;
  }

  double unclamped(const Eigen::VectorXd& y, std::size_t i) const {
    const int a = free_[members_[i].a], b = free_[members_[i].b];
    double value = ideal_[i];
    if (a >= 0) value += column_[i].dot(y.segment<3>(3 * a));
    if (b >= 0) value -= column_[i].dot(y.segment<3>(3 * b));
    return value;
  }

  bool in_bounds(double value, std::size_t i, double lowest) const {
    return members_[i].strut ? value <= 0 : value >= lowest;
  }

  std::vector<double> clamped(const Eigen::VectorXd& y, double lowest) const {
    std::vector<double> w(ideal_.size());
    for (std::size_t i = 0; i < w.size(); ++i) {
      const double value = unclamped(y, i);
      w[i] = in_bounds(value, i, lowest) ? value : members_[i].strut ? 0 : lowest;
    }
    return w;
  }

  Eigen::VectorXd net_force(const std::vector<double>& w) const {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * free_nodes_);
    for (std::size_t i = 0; i < w.size(); ++i) {
      const int a = free_[members_[i].a], b = free_[members_[i].b];
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
      const int a = free_[members_[i].a], b = free_[members_[i].b];
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

  std::vector<Member> members_;
  std::vector<int> free_;  // by node; -1: fixed, or of another piece
  int free_nodes_;
  NodeMatrix matrix_;
  std::vector<double> ideal_, density_;
  std::vector<Eigen::Vector3d> column_;
  double largest_ = 0;  // force of a part at its ideal density
};

Eigen::VectorXd densities_of(NearestBalance balance) {
  for (double lowest : {0.1, 0.01, 0.001, 0.0}) {
    Eigen::VectorXd density = balance.densities(lowest);
    if (density.size() > 0) return density;
  }
  throw geometry::Refusal(
      geometry::refusal::kBadMesh,
      "the control mesh has no prestress that keeps every tensile part taut: its inner nodes may lie "
      "outside, or its triangles be too uneven");
}

}  // namespace

Eigen::VectorXd force_densities(const Model& model, const std::vector<double>& ideal) {
  const std::vector<int> pieces = model.piece_of_members();
  Eigen::VectorXd density(static_cast<Eigen::Index>(ideal.size()));
  for (int piece = 0; piece <= *std::max_element(pieces.begin(), pieces.end()); ++piece) {
    std::vector<Eigen::Index> own;
    std::vector<Member> members;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (pieces[i] != piece) continue;
      own.push_back(static_cast<Eigen::Index>(i));
      members.push_back(model.members[i]);
      sizes.push_back(ideal[i]);
    }
    density(own) = densities_of(NearestBalance(model, members, sizes));
  }
  return density;
}

}  // namespace tensegric_fit::tensegric
