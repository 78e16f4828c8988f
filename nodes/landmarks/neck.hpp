/// The neck: its girth, where it grows out of the trunk. In its own frame, since a stoop takes it along.
#pragma once

#include <string>

#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

struct Neck {
  bool found = false;
  std::string missing;             ///< why it was not found
  Eigen::Vector3d origin;          ///< of the plane of the neck girth: the middle of its loop
  Eigen::Vector3d axis, forwards;  ///< of the neck, in the sagittal plane: up along it, and across
  Eigen::Vector3d base, base_up;   ///< plane through the neck's lowest vertebra, and its normal
  double turn = 0;                 ///< radians by which it leans further forward than on an upright body
  std::vector<Eigen::Vector3d> tape;
  double girth = 0;
  Eigen::Vector3d front;  ///< neck_front, the notch at the throat
  double confidence = 0.9;
  std::string reason;
};

Neck find_neck(const BodyShape& body, const Trunk& trunk);

/// Neck base: the spine's lowest neck vertebra, and where the neck's side meets the shoulder. \pre neck.found
Eigen::Vector3d find_neck_back(const BodyShape& body, const Neck& neck);
Eigen::Vector3d find_neck_side(const BodyShape& body, const Neck& neck, Side side);

}  // namespace tensegric_fit::landmarks
