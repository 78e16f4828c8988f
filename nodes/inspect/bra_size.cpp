#include "inspect/bra_size.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tensegric_fit::inspect {
namespace {

constexpr int kSmallestBandSize = 60, kLargestBandSize = 140;  // bands
constexpr double kBandStep = 5, kCupStep = 2;                  // cm
constexpr double kSmallestCup = 10, kNoise = 1e-6;  // cm; what binary fractions add to decimal ones

/// A value of a normal variable of deviation 1, and its share of all.
struct Likely {
  double value, share;
};

/// Evenly spaced values out to 4 deviations, beyond which lie 6e-5 of all.
std::vector<Likely> likely_values() {
  constexpr int kSteps = 40;
  std::vector<Likely> values;
  double all = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double value = 4.0 * i / kSteps;
    values.push_back({value, std::exp(-0.5 * value * value)});
    all += values.back().share;
  }
  for (Likely& value : values) value.share /= all;
  return values;
}

}  // namespace

std::optional<BraSize> bra_size(double bust, double underbust) {
  const double band = kBandStep * std::floor((100 * underbust + kNoise) / kBandStep + 0.5);
  const double cup = std::ceil((100 * (bust - underbust) - kSmallestCup - kNoise) / kCupStep);
  constexpr int kCups = 27;  // AA, and the alphabet
  if (!(band >= kSmallestBandSize && band <= kLargestBandSize && cup >= 1 && cup <= kCups))
    return std::nullopt;
  const int letter = static_cast<int>(cup) - 2;
  return BraSize{static_cast<int>(band), letter < 0 ? "AA" : std::string(1, static_cast<char>('A' + letter))};
}

std::vector<BraSize> bra_sizes(const geometry::Measure& bust, const geometry::Measure& underbust) {
  constexpr double kDeviations = 1.96;  // of a normal variable's 95 % interval
  const std::optional<BraSize> measured = bra_size(bust.metres, underbust.metres);
  if (!measured || bust.is_unsure() || underbust.is_unsure()) return {};
  static const std::vector<Likely> values = likely_values();
  double own = 0;                                            // how likely the measured size is
  std::map<std::string, std::pair<BraSize, double>> others;  // label -> size and how likely it is
  for (const Likely& a : values)
    for (const Likely& b : values) {
      const auto size = bra_size(bust.metres + a.value * bust.half_width / kDeviations,
                                 underbust.metres + b.value * underbust.half_width / kDeviations);
      if (!size) continue;
      double& share = size->label() == measured->label()
                          ? own
                          : others.try_emplace(size->label(), *size, 0).first->second.second;
      share += a.share * b.share;
    }
  std::vector<BraSize> sizes{*measured};
  const auto likeliest = std::max_element(
      others.begin(), others.end(),
      [](const auto& one, const auto& other) { return one.second.second < other.second.second; });
  if (likeliest != others.end() && (likeliest->second.second >= kOnABorder || own < kInDoubt))
    sizes.push_back(likeliest->second.first);
  return sizes;
}

}  // namespace tensegric_fit::inspect
