#include "inspect/colour_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tensegric_fit::inspect {
namespace {

constexpr double kFarthest = 0.03;                         // metres: the fixed end of displacement
constexpr double kNarrowest = 0.01, kShortestMove = 1e-3;  // share, metres

}  // namespace

ColourScale fixed_scale(ColourBy by) {
  if (by == ColourBy::displacement) return {by, 0, 0, kFarthest};
  return {by, kTightest, 1, kLoosest};
}

ColourScale auto_scale(ColourBy by, const std::vector<double>& values) {
  ColourScale scale = fixed_scale(by);
  double farthest = by == ColourBy::displacement ? kShortestMove : kNarrowest;
  for (const double value : values) farthest = std::max(farthest, std::abs(value - scale.neutral));
  if (by != ColourBy::displacement) scale.low = std::max(0.0, scale.neutral - farthest);
  scale.high = scale.neutral + farthest;
  return scale;
}

Colour colour_of(const ColourScale& scale, double value) {
  if (scale.by == ColourBy::plain || !std::isfinite(value)) return kNeutral;
  const double share = value < scale.neutral ? (value - scale.neutral) / (scale.neutral - scale.low)
                                             : (value - scale.neutral) / (scale.high - scale.neutral);
  return scale.by == ColourBy::displacement ? way_colour(share) : two_sided_colour(share);
}

std::vector<Colour> colours_of(const ColourScale& scale, const std::vector<double>& values) {
  std::vector<Colour> colours(values.size());
  std::transform(values.begin(), values.end(), colours.begin(),
                 [&scale](double value) { return colour_of(scale, value); });
  return colours;
}

std::string words_of(ColourBy by, double value) {
  return by == ColourBy::displacement ? fmt::format("{:.0f} mm", 1e3 * value)
                                      : fmt::format("{:.0f} %", 100 * value);
}

}  // namespace tensegric_fit::inspect
