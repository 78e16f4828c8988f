/// Buttocks and crotch.
#pragma once

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// The most posterior point of a buttock. False where none stands out.
bool find_buttock(const BodyShape& body, Side side, Eigen::Vector3d& point);

/// Where the legs meet the trunk: the middle of the narrowest place between them, at `levels.crotch`.
Eigen::Vector3d find_crotch(const BodyShape& body);

}  // namespace tensegric_fit::landmarks
