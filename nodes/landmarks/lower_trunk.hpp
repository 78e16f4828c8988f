/// Buttocks, the folds under them, hips' sides and crotch.
#pragma once

#include <string>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// The most posterior point of a buttock. False where none stands out.
bool find_buttock(const BodyShape& body, Side side, Eigen::Vector3d& point);

struct GlutealFold {
  Eigen::Vector3d point;
  double confidence;
  std::string reason;
};

/// Where a buttock ends on the thigh: the point of the sagittal profile that lies deepest under a straight
/// edge laid on buttock point and thigh. Where nothing does, a level by proportion.
GlutealFold find_gluteal_fold(const BodyShape& body, const Eigen::Vector3d& buttock);

/// The point of a level outline that is farthest to a side; on a flat side, in the middle of the flat.
/// \pre the outline has points
Eigen::Vector3d side_of(const Outline& outline, Side side);

/// The perineum, at the crotch's height.
Eigen::Vector3d find_crotch(const BodyShape& body);

}  // namespace tensegric_fit::landmarks
