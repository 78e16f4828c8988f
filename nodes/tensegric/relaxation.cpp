#include "tensegric/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "tensegric/strut_relaxation.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kMostCycles = 5000;
constexpr double kSettled = 1e-7;  // largest net force / mean tensile force at rest
constexpr int kWindow = 60;        // cycles over which an oscillation is looked for
constexpr double kSwing = 1e-3;    // smallest swing of a line ratio or volume error that counts as one

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

}  // namespace

Outcome relax(const Problem& problem, const Solution* start, bool adaptive, Recorder& recorder) {
  const int most = problem.options.max_iterations > 0 ? problem.options.max_iterations : kMostCycles;
  StrutRelaxation relaxation(problem, start, adaptive);
  Outcome outcome;
  outcome.state = relaxation.state();
  outcome.residual = relaxation.residual();
  while (outcome.residual > kSettled && outcome.iterations < most) {
    relaxation.cycle();
    const double residual = relaxation.residual();
    if (!relaxation.sane() || !std::isfinite(residual)) {
      outcome.status = Status::diverged;
      return outcome;
    }
    outcome.state = relaxation.state();
    outcome.residual = residual;
    if (!recorder.record(++outcome.iterations, outcome.state.x, residual)) return outcome;
  }
  outcome.status = outcome.residual <= kSettled   ? Status::converged
                   : oscillates(recorder.history) ? Status::oscillating
                                                  : Status::capped;
  return outcome;
}

}  // namespace tensegric_fit::tensegric
