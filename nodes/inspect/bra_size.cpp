#include "inspect/bra_size.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tensegric_fit::inspect {
namespace {

constexpr int kNarrowest = 60, kWidest = 140;       // bands
constexpr double kBandStep = 5, kCupStep = 2;       // cm
constexpr double kSmallestCup = 10, kNoise = 1e-6;  // cm; what binary fractions add to decimal ones

// Places of a normal variable of deviation 1 that are equally likely: the means of so many equal shares of
// it.
std::vector<double> equally_likely() {
  constexpr int kShares = 40, kFine = 400;
  constexpr double kFar = 4;  // deviations; beyond lie 6e-5 of all
  std::vector<double> places(kShares, 0), weights(kShares, 0);
  double below = 0, all = 0;
  const auto density = [](int i) { return std::exp(-0.5 * std::pow(kFar * (2.0 * i / kFine - 1), 2)); };
  for (int i = 0; i <= kFine; ++i) all += density(i);
  for (int i = 0; i <= kFine; ++i) {
    const auto share = std::min<std::size_t>(kShares - 1, static_cast<std::size_t>(kShares * below / all));
    places[share] += density(i) * kFar * (2.0 * i / kFine - 1);
    weights[share] += density(i);
    below += density(i);
  }
  for (std::size_t i = 0; i < places.size(); ++i) places[i] /= weights[i];
  return places;
}

}  // namespace

std::optional<BraSize> bra_size(double bust, double underbust) {
  const double band = kBandStep * std::floor((100 * underbust + kNoise) / kBandStep + 0.5);
  const double cup = std::ceil((100 * (bust - underbust) - kSmallestCup - kNoise) / kCupStep);
  constexpr int kCups = 27;  // AA, and the alphabet
  if (!(band >= kNarrowest && band <= kWidest && cup >= 1 && cup <= kCups)) return std::nullopt;
  const int letter = static_cast<int>(cup) - 2;
  return BraSize{static_cast<int>(band), letter < 0 ? "AA" : std::string(1, static_cast<char>('A' + letter))};
}

std::vector<BraSize> bra_sizes(const geometry::Measure& bust, const geometry::Measure& underbust) {
  constexpr double kDeviations = 1.96;  // of a normal variable's 95 % interval
  const std::optional<BraSize> measured = bra_size(bust.metres, underbust.metres);
  if (!measured) return {};
  static const std::vector<double> places = equally_likely();
  std::map<std::string, std::pair<BraSize, int>> others;
  for (const double a : places)
    for (const double b : places) {
      const auto size = bra_size(bust.metres + a * bust.half_width / kDeviations,
                                 underbust.metres + b * underbust.half_width / kDeviations);
      if (size && size->label() != measured->label())
        ++others.try_emplace(size->label(), *size, 0).first->second.second;
    }
  std::vector<BraSize> sizes{*measured};
  const auto likeliest = std::max_element(
      others.begin(), others.end(),
      [](const auto& one, const auto& other) { return one.second.second < other.second.second; });
  const double all = static_cast<double>(places.size() * places.size());
  if (likeliest != others.end() && likeliest->second.second >= kOnABorder * all)
    sizes.push_back(likeliest->second.first);
  return sizes;
}

}  // namespace tensegric_fit::inspect
