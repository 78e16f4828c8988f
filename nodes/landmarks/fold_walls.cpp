#include "landmarks/fold_walls.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// Skin of breast and chest, millimetres from the fold, that most scans see.
constexpr int kBreastFrom = 15, kBreastTo = 40, kChestFrom = 10, kChestTo = 30;
// The fold is higher by these shares of how far above the place both lines meet and, negative, of how far
// before the chest's line it lies; kUsual more, as that is what a place that was seen well has in sum. Least
// squares over 4,600 profiles of 200 virtual scans; from either half of these the shares are the same to
// 0.02.
constexpr double kMeet = 0.24, kBefore = -0.49, kUsual = 0.0024;  // share, share, m
constexpr double kMeetLowest = -0.015, kMeetHighest = 0.025;  // m; lines that meet further off tell nothing
constexpr double kParallel = 0.2;  // sine of the least angle between two lines that meet

}  // namespace

double fold_above_place(const Profile& profile, int at) {
  const auto breast = profile.line(at, -kBreastTo, -kBreastFrom);
  const auto chest = profile.line(at, kChestFrom, kChestTo);
  if (!breast || !chest) return 0;
  const auto cross = [&](const Vector3d& a, const Vector3d& b) { return a.cross(b).dot(profile.sideways); };
  const double sine = cross(breast->direction, chest->direction);
  if (std::abs(sine) < kParallel) return 0;
  const double along = cross(chest->middle - breast->middle, chest->direction) / sine;
  const double meet = (breast->middle + along * breast->direction - profile.points[at]).z();
  const double before = cross(profile.points[at] - chest->middle, chest->direction);
  return kMeet * std::clamp(meet, kMeetLowest, kMeetHighest) + kBefore * before + kUsual;
}

}  // namespace tensegric_fit::landmarks
