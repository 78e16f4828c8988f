#include "virtual_body/breast.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "virtual_body/implicit.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

const Vector3d kBreastReach(0.080, 0.056, 0.062);  // forward, sideways, down
constexpr double kUp = 0.100;                      // reach upwards: a drop, not a ball
constexpr double kDepth = 0.044;                   // of the middle under the chest wall
constexpr double kOutward = 0.28;                  // radians
constexpr double kSlope = 0.60;                    // how fast its upper half recedes towards the collarbone
constexpr double kNippleHeight = 0.005, kNippleWidth = 0.007;
// The tip lies where the skin looks 25 degrees outwards and a little up.
constexpr double kTipBack = 0.003, kTipOut = 0.008, kTipUp = 0.011;

// Without any firmness: how far the middle sinks and comes out of the chest wall, how much longer the lower
// half grows and the upper half's slope, and how far the tip sinks more, in proportion to the way there and
// its square.
constexpr double kSink = 0.020, kOut = 0.022, kLonger = 0.2, kFlatter = 0.5, kTilt = 0.040, kDroop = 0.020;

}  // namespace

Breast::Breast(const Vector3d& chest, double size, double sag)
    : centre_(chest + Vector3d(kOut * std::min(sag, 1.0) - kDepth, -0.04 * (size - 1),
                               -kSink * sag - 0.06 * (size - 1))),
      local_(Eigen::AngleAxisd(-kOutward, Vector3d::UnitZ()).toRotationMatrix()),
      size_(size),
      sag_(sag) {
  nipple_ = centre_ + size * (local_.transpose() * Vector3d(kBreastReach.x() - kTipBack, kTipOut,
                                                            kTipUp - sag * (kTilt + kDroop)));
}

Vector3d Breast::inside() const {
  return nipple_ -
         0.15 * size_ * kBreastReach.x() * forward();  // no deeper: a breast that hangs is thin there
}

double Breast::value(const Vector3d& p) const {
  constexpr double kSoft = 0.010;  // the tilt sets in over this length
  Vector3d q = local_ * (p - centre_);
  const double reach = size_ * kBreastReach.x(), far = (q.x() + std::hypot(q.x(), kSoft)) / (2 * reach);
  // Sheared downwards; what hangs is thinner across than in its own frame
  const double shear = sag_ * size_ * (kTilt + 2 * kDroop * far) / reach;
  q.z() += sag_ * size_ * (kTilt + kDroop * far) * far;
  Vector3d radii = size_ * kBreastReach;
  if (q.z() > 0) {
    radii.z() = size_ * kUp;
    q.x() += kSlope * (1 + kFlatter * sag_) * q.z() * q.z() / (q.z() + 0.03);
  } else {
    radii.z() *= 1 + kLonger * sag_;
  }
  const double bump = (p - nipple_).squaredNorm() / (2 * kNippleWidth * kNippleWidth);
  return ellipsoid(q, radii) / std::sqrt(1 + shear * shear) -
         (bump < 20 ? kNippleHeight * std::exp(-bump) : 0);
}

}  // namespace tensegric_fit::virtual_body
