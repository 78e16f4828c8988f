/// Breasts that hang over their fold, where no sensor sees it.
#pragma once

#include <array>

#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

/// The trunk's section without the lobe of a breast that hangs on it by a web only: skin with which a
/// reconstruction fills the gap between breast and chest. `bust_points` are those of both sides.
Outline without_hanging_breasts(const Outline& section, const std::array<Eigen::Vector3d, 2>& bust_points,
                                double stature);

/// How far above `fold` (of this side, metres) a breast is one with the chest, though a web joins them below
/// it; 0 where the scan tells nothing else than `fold`.
double fold_above_web(const BodyShape& body, const Trunk& trunk, double fold,
                      const Eigen::Vector3d& bust_point, Side side);

}  // namespace tensegric_fit::landmarks
