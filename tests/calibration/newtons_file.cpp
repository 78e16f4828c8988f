#include "calibration/newtons_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::calibration {

using geometry::Refusal;
namespace refusal = geometry::refusal;

std::optional<double> pull_ratio(const CalibrationCase& one, const CaseOutcome& outcome) {
  if (one.newtons.empty() || outcome.status != tensegric::Status::converged) return std::nullopt;
  double sum = 0;
  for (std::size_t l = 0; l < one.newtons.size(); ++l)
    sum += std::log(std::max(outcome.tensions[l], kLeastPull) / one.newtons[l]);
  return std::exp(sum / static_cast<double>(one.newtons.size()));
}

// A normal distribution of the logarithm round 0, as no pull is corrected by what is seen here.
std::string newtons_yaml(const PullRatios& ratios, int control_triangles, const std::string& made) {
  constexpr double kTwoSided95 = 1.96;  // deviations
  if (ratios.empty()) throw Refusal(refusal::kTooFewData, "no case that converged has tensions");
  double squares = 0;
  for (const auto& [name, ratio] : ratios) squares += std::pow(std::log(ratio), 2);
  const double half_width = kTwoSided95 * std::sqrt(squares / static_cast<double>(ratios.size()));
  if (!std::isfinite(half_width)) throw Refusal(refusal::kNonFinite, "the ratios of pulls are not finite");
  const auto within = std::count_if(ratios.begin(), ratios.end(), [&](const auto& r) {
    return std::abs(std::log(r.second)) <= half_width;
  });
  std::string text = fmt::format(
      "# How near pulls are to the newtons of finite elements: `calibrate CASES --errors --newtons FILE` "
      "wrote "
      "this\n# (tests/calibration/README.md).\nmade: {}\ncontrol_triangles: {}\ncases: {}\nwithin: {}\n"
      "half_width: {:.2f}    # of a pull, 95 %\nratios:    # pull over the reference's\n",
      made, control_triangles, ratios.size(), within, half_width);
  for (const auto& [name, ratio] : ratios) text += fmt::format("  \"{}\": {:.2f}\n", name, ratio);
  return text;
}

}  // namespace tensegric_fit::calibration
