/// Bust points and the fold under the breasts.
#pragma once

#include <string>

#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

struct BustPoint {
  Eigen::Vector3d point;
  double confidence;
  std::string reason;
};

/// Tip of the breast: on the bulge of the half chest that stands out most in a vertical profile, the nipple,
/// or where none is found, the foremost point.
BustPoint find_bust_point(const BodyShape& body, const Trunk& trunk, Side side);

struct Fold {
  Eigen::Vector3d below_bust_point;  ///< most hollow point of the profile through the bust point
  Eigen::Vector3d lowest;            ///< lowest point of the fold from there to 55 mm medial
  double confidence;
  std::string reason;
};

/// Inframammary fold: the most hollow point of the sagittal profile under the breast.
Fold find_fold(const BodyShape& body, const Eigen::Vector3d& bust_point, Side side);

}  // namespace tensegric_fit::landmarks
