#include "booth/breast.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "booth/implicit.hpp"

namespace tensegric_fit::booth {
namespace {

using Eigen::Vector3d;

const Vector3d kReach(0.080, 0.056, 0.062);  // forward, sideways, down
constexpr double kUp = 0.100;                // reach upwards: a drop, not a ball
constexpr double kOutward = 0.28;            // radians
constexpr double kSlope = 0.60;              // how fast its upper half recedes towards the collarbone
constexpr double kSag = 0.045;               // how far the tip sinks without any firmness
constexpr double kNippleHeight = 0.005, kNippleWidth = 0.006;

}  // namespace

Breast::Breast(const Vector3d& centre, double size, double sag)
    : centre_(centre - Vector3d(0, 0.04 * (size - 1), 0.020 * sag + 0.06 * (size - 1))),
      local_(Eigen::AngleAxisd(-kOutward, Vector3d::UnitZ()).toRotationMatrix()),
      size_(size),
      sag_(kSag * sag * size) {
  // The mound's tip: as far forward as the reach, as far down as the sag takes it there
  nipple_ = centre_ + local_.transpose() * Vector3d(size * kReach.x(), 0, -sag_);
}

Vector3d Breast::inside() const {
  return nipple_ - 0.15 * size_ * kReach.x() * forward();  // no deeper: a breast that hangs is thin there
}

double Breast::value(const Vector3d& p) const {
  Vector3d q = local_ * (p - centre_);
  const double reach = size_ * kReach.x(), far = std::max(q.x(), 0.0) / reach;
  // Sheared downwards; what hangs is thinner across than in its own frame
  const double shear = 2 * sag_ * far / reach;
  q.z() += sag_ * far * far;
  Vector3d radii = size_ * kReach;
  if (q.z() > 0) {
    radii.z() = size_ * kUp;
    q.x() += kSlope * q.z() * q.z() / (q.z() + 0.03);
  }
  const double bump = (p - nipple_).squaredNorm() / (2 * kNippleWidth * kNippleWidth);
  return ellipsoid(q, radii) / std::sqrt(1 + shear * shear) -
         (bump < 20 ? kNippleHeight * std::exp(-bump) : 0);
}

}  // namespace tensegric_fit::booth
