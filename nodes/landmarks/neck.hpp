/// The neck: where it is thinnest, where it grows out of the trunk.
#pragma once

#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

struct Neck {
  bool found = false;
  Eigen::Vector3d origin;  ///< of the plane of the neck girth
  Eigen::Vector3d axis;    ///< its normal, up and forward along the neck
  std::vector<Eigen::Vector3d> tape;
  double girth = 0;
  Eigen::Vector3d front;  ///< neck_front, the notch at the throat
};

Neck find_neck(const BodyShape& body, const Trunk& trunk);

/// Neck base. \pre neck.found
Eigen::Vector3d find_neck_back(const BodyShape& body, const Neck& neck);
Eigen::Vector3d find_neck_side(const BodyShape& body, const Neck& neck, Side side);

}  // namespace tensegric_fit::landmarks
