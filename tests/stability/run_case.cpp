#include <algorithm>
#include <chrono>
#include <cmath>

#include "geometry/status.hpp"
#include "stability_case.hpp"
#include "tensegric/members.hpp"
#include "tensegric/problem.hpp"

namespace tensegric_fit::stability {
namespace {

using tensegric::Solution;
using tensegric::SolverName;
using tensegric::Status;

constexpr double kLongest = 60e3;  // ms; the slowest cases take a few seconds

bool all_finite(const Solution& s) {
  const auto finite = [](const Eigen::Vector3d& p) { return p.allFinite(); };
  bool good = std::all_of(s.outer.begin(), s.outer.end(), finite) &&
              std::all_of(s.inner.begin(), s.inner.end(), finite) && std::isfinite(s.residual);
  for (const auto& line : s.lines) good = good && std::isfinite(line.final) && std::isfinite(line.tension);
  for (const auto& region : s.regions) good = good && std::isfinite(region.volume_after);
  for (const auto& row : s.history) {
    good = good && std::isfinite(row.residual);
    for (double ratio : row.line_ratios) good = good && std::isfinite(ratio);
    for (double error : row.volume_errors) good = good && std::isfinite(error);
  }
  return good;
}

bool fixed_nodes_stay(const Case& hard, const Solution& s) {
  for (std::size_t i = 0; i < hard.control.outer.size(); ++i)
    if ((hard.control.outer_fixed[i] && s.outer[i] != hard.control.outer[i]) ||
        (hard.control.inner_fixed[i] && s.inner[i] != hard.control.inner[i]))
      return false;
  return true;
}

// nodes/tensegric/README.md, Exactness, where a balance is claimed; and the last one on the way, where the
// equilibrium solver gave up. The papers' solvers pull lines by pseudo forces only, and leave the volume as
// it comes (relaxation) or bring it back to about 1e-6 % (adaptive, P2 §4).
void check_balance(const Ending& ending, const tensegric::SolverOptions& options, Status status,
                   std::vector<std::string>& faults) {
  const SolverName solver = options.solver;
  const bool exact = solver == SolverName::equilibrium;
  if (exact && status == Status::capped && !(ending.residual <= 1 && ending.volume_error <= 1e-9))
    faults.push_back("what is handed back is no balance");
  if (status != Status::converged && status != Status::infeasible) return;
  if (!(ending.residual <= 1e-8)) faults.push_back("residual above 1e-8");
  if (solver != SolverName::relaxation && (exact || options.volume_force > 0) &&
      !(ending.volume_error <= (exact ? 1e-9 : 1e-8)))
    faults.push_back("volume not kept");
  if (exact && status == Status::converged && !(ending.line_error <= 1e-6))
    faults.push_back("line not exact");
}

}  // namespace

double prestress_residual(const geometry::ControlMesh& control) {
  const tensegric::Model model = tensegric::build_model(control, {});
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * model.free_nodes());
  add_member_gradient(model, model.rest_positions(), model.free_index(), gradient);
  return gradient.size() == 0 ? 0 : gradient.cwiseAbs().maxCoeff() / model.mean_tension();
}

Ending run(const Case& hard, SolverName solver, int most_iterations) {
  Ending ending;
  const auto start = std::chrono::steady_clock::now();
  try {
    tensegric::SolverOptions options = hard.solver;
    options.solver = solver;
    if (solver != SolverName::equilibrium && options.max_iterations == 0)
      options.max_iterations = most_iterations;
    const tensegric::Model model = tensegric::build_model(hard.control, hard.model);
    const Solution s = tensegric::solve(model, hard.garment, options, hard.start ? &*hard.start : nullptr, {},
                                        {}, hard.laid);
    ending.status = to_string(s.status);
    ending.iterations = s.iterations;
    ending.residual = s.residual;
    for (std::size_t b = 0; b < s.lines.size(); ++b)
      if (hard.garment.lines[b].law.kind == tensegric::TensionLaw::Kind::rigid)
        ending.line_error = std::max(ending.line_error, s.lines[b].final / s.lines[b].neutral - 1);
    for (std::size_t b = 0; b < s.lines.size(); ++b)
      if (solver == SolverName::equilibrium && s.status == Status::converged &&
          hard.garment.lines[b].law.kind == tensegric::TensionLaw::Kind::rigid && s.lines[b].tension > 1e-9 &&
          s.lines[b].final < s.lines[b].neutral * (1 - 1e-6))
        ending.faults.push_back("a line that pulls is shorter than asked for");
    for (const auto& region : hard.control.regions)
      ending.volume_error = std::max(
          ending.volume_error, std::abs(volume_error(region_volume_of(model, region), positions_of(s))));
    if (!all_finite(s)) ending.faults.push_back("not finite");
    if (!fixed_nodes_stay(hard, s)) ending.faults.push_back("a fixed node moved");
    if (!hard.refusal.empty() && hard.refusal != "?") ending.faults.push_back("not refused");
    if (solver == SolverName::equilibrium &&
        (s.status == Status::diverged || s.status == Status::oscillating))
      ending.faults.push_back(ending.status);
    for (const auto& row : s.history)
      if (row.merit_change > 1e-12) ending.faults.push_back("merit rises");
    check_balance(ending, options, s.status, ending.faults);
  } catch (const geometry::Refusal& refusal) {
    ending.status = refusal.code();
    ending.refused = true;
    if (hard.refusal != refusal.code() && hard.refusal != "?")
      ending.faults.push_back(std::string("refused: ") + refusal.what());
  } catch (const std::exception& other) {
    ending.status = "exception";
    ending.faults.push_back(other.what());
  }
  ending.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (ending.ms > kLongest) ending.faults.push_back("took too long");
  return ending;
}

}  // namespace tensegric_fit::stability
