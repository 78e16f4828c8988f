#include "tensegric/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "tensegric/extrapolation.hpp"
#include "tensegric/strut_relaxation.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kMostCycles = 5000;
constexpr double kSettled = 1e-8;     // largest net force / mean tensile force at rest
constexpr double kVolumeKept = 5e-9;  // relative; P2 §4 has 1e-6
constexpr int kWindow = 60;           // cycles over which an oscillation is looked for
constexpr double kSwing = 1e-3;       // smallest swing of a line ratio or volume error that counts as one
constexpr int kPlainCycles = 300;     // before the slow rest is extrapolated, as no paper does
constexpr int kRemembered = 10;       // cycles that it is extrapolated from
constexpr double kRisen = 10;         // times the least residual: the extrapolation starts anew

// A swing that does not die down: several reversals in the window, as wide in its later half as in its
// earlier.
bool swings(const std::vector<double>& values) {
  const std::size_t half = values.size() / 2;
  const auto spread = [&](std::size_t from, std::size_t to) {
    const auto range = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(from),
                                           values.begin() + static_cast<std::ptrdiff_t>(to));
    return *range.second - *range.first;
  };
  int reversals = 0;
  for (std::size_t i = 2; i < values.size(); ++i)
    if ((values[i] - values[i - 1]) * (values[i - 1] - values[i - 2]) < 0) ++reversals;
  return reversals >= 4 && spread(half, values.size()) > kSwing &&
         spread(half, values.size()) > 0.8 * spread(0, half);
}

bool oscillates(const std::vector<Iterate>& history) {
  if (history.size() < kWindow) return false;
  const Iterate& last = history.back();
  const auto series = [&](auto value) {
    std::vector<double> values;
    for (std::size_t i = history.size() - kWindow; i < history.size(); ++i)
      values.push_back(value(history[i]));
    return values;
  };
  for (std::size_t b = 0; b < last.line_ratios.size(); ++b)
    if (swings(series([b](const Iterate& i) { return i.line_ratios[b]; }))) return true;
  for (std::size_t r = 0; r < last.volume_errors.size(); ++r)
    if (swings(series([r](const Iterate& i) { return i.volume_errors[r]; }))) return true;
  return false;
}

// Balanced as far as forces go, the adaptive solver may still be on its way back to the volume (P2 §5).
bool brings_volume_back(const Problem& problem, const Positions& x) {
  return problem.options.volume_force > 0 &&
         std::any_of(problem.volumes.begin(), problem.volumes.end(), [&x](const RegionVolume& region) {
           return std::abs(volume_error(region, x)) > kVolumeKept;
         });
}

// Where it came nearest to balance.
struct Nearest {
  State state;
  double residual = 0;
  int cycle = 0;
};

}  // namespace

Outcome relax(const Problem& problem, const Solution* start, bool adaptive, Recorder& recorder) {
  const int most = problem.options.max_iterations > 0 ? problem.options.max_iterations : kMostCycles;
  const double budget = problem.options.time_budget;
  StrutRelaxation relaxation(problem, start, adaptive);
  Outcome outcome;
  outcome.state = relaxation.state();
  outcome.residual = relaxation.residual();
  Nearest nearest{outcome.state, outcome.residual, 0};
  Eigen::VectorXd before = relaxation.packed();
  Extrapolation extrapolation(before.size(), kRemembered);
  const auto settle_for = [&](Status status, const std::string& what) {
    outcome.state = nearest.state;
    outcome.residual = nearest.residual;
    outcome.status = status;
    outcome.note = what + " after " + std::to_string(outcome.iterations) + " cycles: this is cycle " +
                   std::to_string(nearest.cycle) + ", the nearest to a balance.";
    return outcome;
  };
  const auto settled = [&] {
    return outcome.residual <= kSettled && !(adaptive && brings_volume_back(problem, outcome.state.x));
  };
  while (!settled() && outcome.iterations < most) {
    const bool extrapolates = outcome.iterations >= kPlainCycles;
    if (extrapolates) before = relaxation.packed();
    relaxation.cycle();
    ++outcome.iterations;
    const double residual = relaxation.residual();
    if (!relaxation.sane() || !std::isfinite(residual))
      return settle_for(Status::diverged, "The forces of lines and volumes drove each other up; stopped");
    outcome.state = relaxation.state();
    outcome.residual = residual;
    if (residual < nearest.residual) nearest = {outcome.state, residual, outcome.iterations};
    if (!recorder.record(outcome.iterations, outcome.state.x, residual)) return outcome;
    if (budget > 0 && recorder.seconds() >= budget && !settled())
      return settle_for(Status::capped, "The time budget ended");
    if (!extrapolates) continue;
    if (residual > kRisen * nearest.residual)
      extrapolation.restart();
    else
      relaxation.unpack(extrapolation.next(before, relaxation.packed()));
  }
  if (!settled())
    return oscillates(recorder.history)
               ? settle_for(Status::oscillating, "The forces of lines and volumes swing")
               : settle_for(Status::capped, "The cycles ended");
  outcome.status = Status::converged;
  return outcome;
}

}  // namespace tensegric_fit::tensegric
