#include "landmarks/arm_cut.hpp"

#include <algorithm>

namespace tensegric_fit::landmarks {
namespace {

// A round limb cut along its diameter has a girth of 1.57 chords; the side of a trunk with a fold less
// than 2.
constexpr double kGirthToChord = 2.2;
constexpr double kSmallestGirth = 0.08;  // of stature: a hand's
constexpr double kSmallestReach =
    0.055;  // of stature: a cut stays this far from the trunk's middle, half a narrow waist

Outline without_lobe(const Outline& trunk, double sign, double middle, double stature) {
  const std::vector<Eigen::Vector3d>& points = trunk.points;
  const int count = static_cast<int>(points.size());
  int tip = 0;
  for (int i = 1; i < count; ++i)
    if (sign * points[i].y() > sign * points[tip].y()) tip = i;

  // Arc length from the tip, forwards and backwards, no further than half the points each way.
  const auto at = [&](int steps) -> const Eigen::Vector3d& {
    return points[((tip + steps) % count + count) % count];
  };
  const int reach = count / 2 - 1;
  std::vector<double> ahead{0}, behind{0};
  for (int i = 1; i <= reach; ++i) {
    ahead.push_back(ahead.back() + (at(i) - at(i - 1)).norm());
    behind.push_back(behind.back() + (at(-i) - at(1 - i)).norm());
  }
  double best = 1 / kGirthToChord;
  int first = 0, last = 0;
  for (int i = 1; i <= reach && sign * (at(-i).y() - middle) > kSmallestReach * stature; ++i) {
    for (int j = 1; j <= reach && sign * (at(j).y() - middle) > kSmallestReach * stature; ++j) {
      const double girth = ahead[j] + behind[i];
      const double chord = (at(j) - at(-i)).norm();
      if (girth < kSmallestGirth * stature || chord >= best * girth) continue;
      best = chord / girth;
      first = i;
      last = j;
    }
  }
  if (first == 0) return trunk;
  std::vector<Eigen::Vector3d> rest;
  for (int i = last; i <= count - first; ++i) rest.push_back(at(i));
  return rest.size() < 3 ? trunk : outline_of(std::move(rest));
}

}  // namespace

Outline without_arms(const Outline& trunk, double stature) {
  const double middle = (trunk.low.y() + trunk.high.y()) / 2;
  return without_lobe(without_lobe(trunk, 1, middle, stature), -1, middle, stature);
}

}  // namespace tensegric_fit::landmarks
