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
  Eigen::Vector3d below_bust_point;  ///< where the fold begins, mostly on the bust point's profile
  double lowest;                     ///< metres, height of the fold's lowest point from there to 55 mm medial
  double by_walls;  ///< that height as breast and chest further off tell it, which scans mostly see
  double confidence;
  std::string reason;
  bool in_pocket = false;  ///< between breast and chest that are too close to see far into
};

/// Inframammary fold: the most hollow point of the sagittal profile under the breast.
Fold find_fold(const BodyShape& body, const Eigen::Vector3d& bust_point, Side side);

}  // namespace tensegric_fit::landmarks
