#include "geometry/bra_size.hpp"

#include <cmath>

namespace tensegric_fit::geometry {
namespace {

constexpr int kNarrowest = 60, kWidest = 140;       // bands
constexpr double kBandStep = 5, kCupStep = 2;       // cm
constexpr double kSmallestCup = 10, kNoise = 1e-6;  // cm; what binary fractions add to decimal ones

}  // namespace

std::optional<BraSize> bra_size(double bust, double underbust) {
  const double band = kBandStep * std::floor((100 * underbust + kNoise) / kBandStep + 0.5);
  const double cup = std::ceil((100 * (bust - underbust) - kSmallestCup - kNoise) / kCupStep);
  constexpr int kCups = 27;  // AA, and the alphabet
  if (!(band >= kNarrowest && band <= kWidest && cup >= 1 && cup <= kCups)) return std::nullopt;
  const int letter = static_cast<int>(cup) - 2;
  return BraSize{static_cast<int>(band), letter < 0 ? "AA" : std::string(1, static_cast<char>('A' + letter))};
}

}  // namespace tensegric_fit::geometry
