/// The gap between the trunk and what is beside it in a section.
#pragma once

#include <vector>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// How far an outline reaches to a side from the body's middle.
double reach(const Outline& outline, Side side);

/// Middle of the narrowest place between `trunk` and the outlines beside it; false where all are `widest`
/// metres away or more.
bool gap_beside(const Outline& trunk, const std::vector<Outline>& outlines, Side side, double widest,
                Eigen::Vector3d& middle);

}  // namespace tensegric_fit::landmarks
