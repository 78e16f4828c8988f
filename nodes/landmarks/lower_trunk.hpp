/// Buttocks and crotch.
#pragma once

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// The most posterior point of a buttock. False where none stands out.
bool find_buttock(const BodyShape& body, Side side, Eigen::Vector3d& point);

/// The perineum, at the crotch's height.
Eigen::Vector3d find_crotch(const BodyShape& body);

}  // namespace tensegric_fit::landmarks
