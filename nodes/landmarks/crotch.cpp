#include "landmarks/crotch.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

// Thighs touch, or a wide gap was filled, where so far below the junction they are joined over that share of
// their depth.
constexpr double kHidden = 0.006, kBelowJunction = 0.009, kTouching = 0.15;  // statures, statures, share
constexpr double kApart = 0.0025;                                            // m, between sections
constexpr int kReach = 2;  // sections each way over which a slope is taken
constexpr int kGrown = 4;  // sections above, 10 mm, where what joins the legs has a good part of their depth
constexpr double kShareOfLimb = 0.5;
constexpr double kStillSteep = 0.85;                             // of the steepest slope
constexpr double kLowestCrotch = 0.435, kHighestCrotch = 0.505;  // statures over the soles

// What joins the legs is soon as long as the pelvis is deep, whatever fills the gap below: this share of its
// length so many sections further up, and how far over the perineum that is.
struct Grown {
  double share;
  int further_up;
  double over_perineum;  // m
};
constexpr Grown kApartThighs{0.7, 6, 0.0040}, kTouchingThighs{0.8, 8, 0.0073};
// Of thighs that touch this mark is weaker than the slope behind.
constexpr double kSlopeOverPerineum = 0.0026;  // m; the steep stretch begins at the perineum
constexpr double kWeightOfSlope = 0.65, kAgree = 0.009;

// Bridges between the legs at the middle, kApart apart from `low` on.
struct Bridges {
  double low;
  std::vector<Bridge> at;
};

Bridges bridges_between(const SlicedMesh& sliced, double low, double high, double y) {
  Bridges bridges{low, {}};
  for (double z = low; z <= high; z += kApart)
    bridges.at.push_back(narrowest_bridge(sliced.outlines_at(z), y, y));
  return bridges;
}

// The highest place below which the bridge is shorter than that, less its height over the perineum; or
// `otherwise`.
double by_length(const Bridges& bridges, const Grown& grown, double otherwise) {
  const auto missing = [&](int i) {
    return grown.share * bridges.at[i + grown.further_up].length - bridges.at[i].length;
  };
  for (int i = static_cast<int>(bridges.at.size()) - grown.further_up - 2; i >= 0; --i)
    if (missing(i) > 0 && missing(i + 1) <= 0)
      return bridges.low + (i + missing(i) / (missing(i) - missing(i + 1))) * kApart - grown.over_perineum;
  return otherwise;
}

// The back end of what joins the legs, seen from behind: going up, it recedes gently along thighs that touch,
// steeply round the perineum, and gently again between the buttocks. By the middle of the steep stretch, or
// `otherwise`.
double by_slope_behind(const Bridges& bridges, double lowest, double limb_depth, double otherwise) {
  const int count = static_cast<int>(bridges.at.size());
  std::vector<double> slopes(count, 0);
  for (int i = kReach; i + kGrown < count; ++i)
    if (bridges.low + (i - kReach) * kApart >= lowest && bridges.at[i - kReach].length > 0 &&
        bridges.at[i + kGrown].length > kShareOfLimb * limb_depth)
      slopes[i] = bridges.at[i - kReach].back - bridges.at[i + kReach].back;
  const int steepest = static_cast<int>(std::max_element(slopes.begin(), slopes.end()) - slopes.begin());
  if (slopes[steepest] <= 0) return otherwise;
  int first = steepest, last = steepest;
  while (first > 0 && slopes[first - 1] > kStillSteep * slopes[steepest]) --first;
  while (last + 1 < count && slopes[last + 1] > kStillSteep * slopes[steepest]) ++last;
  return bridges.low + kApart * (first + last) / 2 - kSlopeOverPerineum;
}

}  // namespace

Junction find_crotch_junction(const SlicedMesh& sliced, const BodyLevels& levels) {
  const Level& parted = levels.parted();
  const Outline *left = &parted.outlines[parted.legs[0]], *right = &parted.outlines[parted.legs[1]];
  if (left->centroid.y() < right->centroid.y()) std::swap(left, right);
  // In statures: the gap between thighs stays this near its middle, and this far up at the most it can be
  // filled.
  const double middle = (left->low.y() + right->high.y()) / 2, reach = 0.008 * levels.stature;
  const double depth = left->high.x() - left->low.x(), s = levels.stature;
  Junction junction = find_junction(
      sliced, {parted.height - 0.01 * s, parted.height + 0.11 * s, middle - reach, middle + reach, depth});
  const std::vector<Outline> below = sliced.outlines_at(junction.height - kBelowJunction * s);
  const bool touching = junction.height - parted.height > kHidden * s &&
                        narrowest_bridge(below, middle, middle).length > kTouching * depth;

  const double soles = levels.levels.front().height - levels.step / 2;
  const double lowest = soles + kLowestCrotch * s;
  const Bridges bridges = bridges_between(sliced, std::max(parted.height - 0.01 * s, lowest - 0.03 * s),
                                          soles + kHighestCrotch * s, middle);
  if (touching) {
    const double by_slope = by_slope_behind(bridges, std::max(parted.height, lowest), depth, junction.height);
    const double grown =
        std::clamp(by_length(bridges, kTouchingThighs, by_slope), by_slope - kAgree, by_slope + kAgree);
    junction.height = kWeightOfSlope * by_slope + (1 - kWeightOfSlope) * grown;
  } else {
    junction.height = by_length(bridges, kApartThighs, junction.height);
  }
  junction.above.y = middle;
  return junction;
}

}  // namespace tensegric_fit::landmarks
