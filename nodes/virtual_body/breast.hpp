/// One breast of the parametric body.
#pragma once

#include <Eigen/Core>

namespace tensegric_fit::virtual_body {

/// A drop on the chest wall with a nipple at its tip; a left one. Metres, x forward, y left, z up.
class Breast {
 public:
  /// `chest`: on the chest wall under it; `sag`: 0 is firm, 1 soft, more hangs over the fold.
  Breast(const Eigen::Vector3d& chest, double size, double sag);

  /// Negative inside, near the distance in metres.
  double value(const Eigen::Vector3d& p) const;
  /// A point inside, on the way from the chest to the nipple's tip, and that way.
  Eigen::Vector3d inside() const;
  Eigen::Vector3d forward() const { return local_.row(0); }
  const Eigen::Vector3d& centre() const { return centre_; }

 private:
  Eigen::Vector3d centre_;
  Eigen::Matrix3d local_;  // rows: forward along the breast, sideways, up
  double size_, sag_;
  Eigen::Vector3d nipple_;  // top of the breast under the nipple
};

}  // namespace tensegric_fit::virtual_body
