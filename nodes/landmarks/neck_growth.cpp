#include "landmarks/neck_growth.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.001, kReach = 0.020;  // m along the neck
constexpr double kNoNeck = 1;                    // m round; there is no tape
// Deviations, m: of the base's level as the skin under the chin tells it, of its girth as growth tells it.
constexpr double kLevelDeviation = 0.0015, kGirthDeviation = 0.008;

// Girth at the base of a neck whose thinnest loop is so long; the thicker, the more it grows down to there.
double girth_at_base(double thinnest, double stature) {
  const double thick = std::max(0.0, thinnest / stature - 0.170);
  return thinnest * (1.008 + 1.26 * thick + 32.5 * thick * thick);
}

}  // namespace

double offset_by_growth(const NeckPlanes& planes, const NeckPlane& base, double thinnest, double stature) {
  const double wanted = girth_at_base(thinnest, stature), here = planes.girth(base.origin, base.lean);
  if (here == wanted || here > kNoNeck) return 0;
  const double step = here > wanted ? kStep : -kStep;  // girth grows downwards
  const Vector3d axis = NeckPlanes::normal_of(base.lean);
  double last = here;
  for (int i = 1; i * kStep <= kReach; ++i) {
    const double girth = planes.girth(base.origin + i * step * axis, base.lean);
    if ((girth > wanted) == (here > wanted)) {
      last = girth;
      continue;
    }
    const double offset = step * (i - 1 + (last - wanted) / (last - girth));
    const double by_level = kLevelDeviation * (here - wanted) / offset;  // its deviation as one of the girth
    return offset * by_level * by_level / (by_level * by_level + kGirthDeviation * kGirthDeviation);
  }
  return 0;
}

}  // namespace tensegric_fit::landmarks
