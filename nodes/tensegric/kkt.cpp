#include "tensegric/kkt.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tensegric/members.hpp"
#include "tensegric/tension_law.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kMostTries = 12;
constexpr double kEigenvalueRounding = 1e-12;             // of the largest eigenvalue
constexpr double kLeastTakenBack = 1.0 / 1024;            // of the negative parts
constexpr double kTakenChange = 4, kRaiseChange = 8;      // from one try to the next
constexpr double kFirstRaise = 1e-3, kLeastRaise = 1e-9;  // of the diagonal / spring of a part

std::vector<LengthCurvature> curvatures_of(const Problem& problem) {
  std::vector<LengthCurvature> curvatures;
  for (const Band& band : problem.bands) curvatures.emplace_back(band, problem.free_index);
  return curvatures;
}

std::vector<std::pair<int, int>> coupled_nodes(const Problem& problem,
                                               const std::vector<LengthCurvature>& curvatures) {
  std::vector<std::pair<int, int>> pairs;
  const auto couple = [&](int a, int b) {
    if (problem.free_index[a] >= 0 && problem.free_index[b] >= 0)
      pairs.emplace_back(problem.free_index[a], problem.free_index[b]);
  };
  for (const Member& m : problem.model.members) couple(m.a, m.b);
  const auto couple_all = [&](const std::array<int, 6>& nodes) {
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j < i; ++j) couple(nodes[i], nodes[j]);
  };
  for (const UnitVolume& unit : problem.units) couple_all(unit.nodes);
  for (const UnitShear& unit : problem.shears) couple_all(unit.nodes);
  for (const Column& column : problem.columns.columns)
    for (std::size_t i = 1; i < column.nodes.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(column.nodes[i], column.nodes[j]);
  for (const SkinTriangle& one : problem.skin)
    for (int i = 0; i < 3; ++i) couple(one.nodes[i], one.nodes[(i + 1) % 3]);
  for (const LengthCurvature& curvature : curvatures)
    for (const auto& pair : curvature.coupled_nodes()) pairs.push_back(pair);
  return pairs;
}

// A band's condition: zero where it does what its hold says.
double band_condition(const Band& band, Hold hold, double length, double neutral, double limit,
                      double tension) {
  switch (hold) {
    case Hold::length:
      return length - neutral * law_stretch(band.law, tension);
    case Hold::elastic:
      return law_tension(band.law, length / neutral) - tension;
    case Hold::limit:
      return limit - tension;
    case Hold::slack:
      break;
  }
  return -tension;
}

}  // namespace

Kkt::Kkt(const Problem& problem)
    : problem_(problem),
      regions_(static_cast<int>(problem.volumes.size())),
      bands_(static_cast<int>(problem.bands.size())),
      raise_(kFirstRaise),
      curvatures_(curvatures_of(problem)),
      hessian_(problem.free_nodes, coupled_nodes(problem, curvatures_)),
      factor_(hessian_) {}

KktResidual Kkt::defect(const Balance& at, const Load& load) const {
  KktResidual result;
  result.jacobian.setZero(3 * problem_.free_nodes, regions_ + bands_);
  result.conditions.resize(regions_ + bands_);
  Eigen::VectorXd multipliers(regions_ + bands_);
  multipliers << at.pressures, at.tensions;
  for (int r = 0; r < regions_; ++r) {
    const RegionVolume& region = problem_.volumes[r];
    const double now =
        add_volume_gradient(region, at.x, problem_.free_index, -1 / region.area, result.jacobian.col(r));
    result.conditions[r] = (region.rest - now) / region.area;
    result.volume_error = std::max(result.volume_error, std::abs(volume_error(region, now)));
  }
  for (int b = 0; b < bands_; ++b) {
    const Band& band = problem_.bands[b];
    const double length =
        add_length_gradient(band, at.x, problem_.free_index, 1, result.jacobian.col(regions_ + b));
    const double error =
        band_condition(band, at.holds[b], length, load.neutral[b], load.limit[b], at.tensions[b]);
    result.conditions[regions_ + b] = error;
    if (at.holds[b] == Hold::length)
      result.length_error = std::max(result.length_error, std::abs(error) / load.neutral[b]);
    else
      result.tension_error = std::max(result.tension_error, std::abs(error) / problem_.force_scale);
  }
  result.gradient = result.jacobian * multipliers;
  add_member_gradient(problem_.model, at.x, problem_.free_index, result.gradient);
  add_fold_gradient(problem_.units, at.x, problem_.free_index, result.gradient);
  add_pressure_gradient(problem_.columns, at.x, problem_.free_index, result.gradient);
  add_shear_gradient(problem_.shears, at.x, problem_.free_index, result.gradient);
  add_skin_gradient(problem_.skin, at.x, problem_.free_index, result.gradient);
  for (std::size_t i = 0; i < problem_.model.control.outer.size(); ++i)
    if (problem_.free_index[i] >= 0) result.gradient.segment<3>(3 * problem_.free_index[i]) -= load.gravity;
  result.residual = relative_residual(problem_, result.gradient);
  return result;
}

double Kkt::energy(const Balance& at, const Load& load) const {
  double energy = member_energy(problem_.model, at.x) + fold_energy(problem_.units, at.x) +
                  pressure_energy(problem_.columns, at.x) + shear_energy(problem_.shears, at.x) +
                  skin_energy(problem_.skin, at.x);
  for (std::size_t i = 0; i < problem_.model.control.outer.size(); ++i)
    if (problem_.free_index[i] >= 0) energy -= load.gravity.dot(at.x[i] - problem_.rest[i]);
  for (int b = 0; b < bands_; ++b) {
    const Band& band = problem_.bands[b];
    if (at.holds[b] == Hold::limit) energy += load.limit[b] * smooth_length(band, at.x);
    if (at.holds[b] == Hold::elastic)
      energy += load.neutral[b] * law_work(band.law, smooth_length(band, at.x) / load.neutral[b]);
    if (at.holds[b] == Hold::length)
      energy += load.neutral[b] * law_work_by_tension(band.law, at.tensions[b]);
  }
  return energy;
}

void Kkt::assemble(const Balance& at, const std::vector<StraightPush>& lines, double whole) {
  hessian_.clear();
  add_member_hessian(problem_.model, at.x, problem_.free_index, hessian_, whole);
  add_fold_hessian(problem_.units, at.x, lines, problem_.free_index, hessian_, whole);
  add_pressure_hessian(problem_.columns, at.x, problem_.free_index, hessian_, whole);
  add_shear_hessian(problem_.shears, at.x, problem_.free_index, hessian_, whole);
  add_skin_hessian(problem_.skin, at.x, problem_.free_index, hessian_, whole);
  for (int b = 0; b < bands_; ++b) curvatures_[b].add(at.x, std::max(0.0, at.tensions[b]), hessian_);
  for (int r = 0; r < regions_; ++r)
    add_volume_hessian(problem_.volumes[r], at.x, problem_.free_index,
                       -whole * at.pressures[r] / problem_.volumes[r].area, hessian_);
}

// Factorises, solves for `gradient` and forms the Schur complement; true where the
// balance is a minimum under its conditions: by the law of inertia, where the matrix has as many negative
// pivots as the complement has negative eigenvalues.
bool Kkt::factorise(const Balance& at, const Load& load, const KktResidual& defect,
                    const Eigen::VectorXd& gradient) {
  usable_ = factor_.factorise(hessian_);
  ++factorisations_;
  if (!usable_) return false;
  const int count = regions_ + bands_;
  Eigen::MatrixXd right(gradient.size(), count + 1);
  right.leftCols(count) = defect.jacobian;
  right.col(count) = gradient;
  solved_ = factor_.solve(right);
  free_move_ = solved_.col(count);
  solved_.conservativeResize(Eigen::NoChange, count);
  by_length_.setOnes(count);
  by_multiplier_.setZero(count);
  for (int b = 0; b < bands_; ++b) {
    const Band& band = problem_.bands[b];
    if (at.holds[b] == Hold::length) {
      by_multiplier_[regions_ + b] = load.neutral[b] * law_compliance(band.law, at.tensions[b]);
      continue;
    }
    by_multiplier_[regions_ + b] = 1;
    by_length_[regions_ + b] =
        at.holds[b] == Hold::elastic
            ? law_slope(band.law, smooth_length(band, at.x) / load.neutral[b]) / load.neutral[b]
            : 0;
  }
  const Eigen::MatrixXd product = defect.jacobian.transpose() * solved_;
  schur_ = by_length_.asDiagonal() * product;
  schur_.diagonal() += by_multiplier_;
  schur_factor_.compute(schur_);

  const int negative = factor_.negative_pivots();
  if (negative == 0) return true;
  std::vector<int> kept;
  for (int i = 0; i < count; ++i)
    if (by_length_[i] > 0) kept.push_back(i);
  if (kept.empty()) return false;
  Eigen::MatrixXd compliance(kept.size(), kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = 0; j < kept.size(); ++j)
      compliance(i, j) =
          product(kept[i], kept[j]) + (i == j ? by_multiplier_[kept[i]] / by_length_[kept[i]] : 0);
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(compliance, Eigen::EigenvaluesOnly).eigenvalues();
  // of 0, but for rounding, where conditions repeat each other or nothing can move
  const double zero = kEigenvalueRounding * values.cwiseAbs().maxCoeff();
  return (values.array() < -zero).count() == negative;
}

Step Kkt::step(const Balance& at, const Load& load, const KktResidual& defect, bool to_saddle,
               bool foreseen) {
  Step result;
  result.lines = straight_pushes(problem_.units, at.x, foreseen ? at.pushes : Eigen::VectorXd());
  Eigen::VectorXd gradient = defect.gradient;
  add_straight_difference(problem_.units, at.x, result.lines, problem_.free_index, gradient);
  assemble(at, result.lines, 1);
  result.minimum = factorise(at, load, defect, gradient);
  if (!result.minimum && !(to_saddle && usable_)) {
    raise_ = std::max(kLeastRaise, raise_ / kRaiseChange);
    taken_back_ = std::max(kLeastTakenBack, taken_back_ / kTakenChange);
    for (int tries = 0; tries < kMostTries; ++tries) {
      assemble(at, result.lines, 1 - taken_back_);
      hessian_.add_to_diagonal(raise_ * spring(problem_.model.members.back()));
      if (factorise(at, load, defect, gradient)) break;
      raise_ *= kRaiseChange;
      taken_back_ = std::min(1.0, kTakenChange * taken_back_);
    }
  }
  if (!usable_) {
    result.move.setConstant(defect.gradient.size(), std::numeric_limits<double>::quiet_NaN());
    return result;
  }
  take_multipliers(defect, free_move_, result);
  result.push_change = pushes_after(problem_.units, at.x, result.lines, problem_.free_index, result.move);
  for (std::size_t k = 0; k < result.lines.size(); ++k)
    result.push_change[static_cast<Eigen::Index>(k)] -= result.lines[k].push;
  return result;
}

Step Kkt::step_again(const KktResidual& defect) const {
  Step result;
  take_multipliers(defect, factor_.solve(defect.gradient), result);
  return result;
}

void Kkt::take_multipliers(const KktResidual& defect, const Eigen::VectorXd& free_move, Step& step) const {
  const Eigen::VectorXd wanted =
      defect.conditions - by_length_.asDiagonal() * (defect.jacobian.transpose() * free_move);
  step.multipliers = schur_factor_.solve(wanted);
  step.left_over = wanted - schur_ * step.multipliers;
  step.move = -(free_move + solved_ * step.multipliers);
}

Eigen::VectorXd Kkt::correction(const Eigen::VectorXd& conditions) const {
  return -(solved_ * schur_factor_.solve(conditions));
}

Eigen::VectorXd Kkt::shortest_move(const KktResidual& defect, const Eigen::VectorXd& conditions) {
  const Eigen::MatrixXd product = defect.jacobian.transpose() * defect.jacobian;
  return -(defect.jacobian * product.completeOrthogonalDecomposition().solve(conditions));
}

void Kkt::guess_multipliers(Balance& at, const Load& load) const {
  at.pressures.setZero(regions_);
  for (int b = 0; b < bands_; ++b)
    if (at.holds[b] == Hold::length) at.tensions[b] = 0;
  const KktResidual rest = defect(at, load);
  std::vector<int> open;
  for (int i = 0; i < regions_ + bands_; ++i)
    if (i < regions_ || at.holds[i - regions_] == Hold::length) open.push_back(i);
  Eigen::MatrixXd columns(rest.gradient.size(), static_cast<Eigen::Index>(open.size()));
  for (std::size_t k = 0; k < open.size(); ++k) columns.col(k) = rest.jacobian.col(open[k]);
  const Eigen::VectorXd best = (columns.transpose() * columns)
                                   .completeOrthogonalDecomposition()
                                   .solve(-columns.transpose() * rest.gradient);
  for (std::size_t k = 0; k < open.size(); ++k)
    (open[k] < regions_ ? at.pressures[open[k]] : at.tensions[open[k] - regions_]) = best[k];
}

}  // namespace tensegric_fit::tensegric
