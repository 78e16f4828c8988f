/// The nipple: a small bump on the smooth skin of a breast.
#pragma once

#include <optional>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// Tip of the nipple near the breast's apex, found in spite of noise that is as high as what a
/// reconstruction leaves of it: the place where a bump of a nipple's size, fitted together with a smooth
/// cubic surface to all skin around, stands out most clearly from the fit's own errors. None where no bump
/// does.
std::optional<Eigen::Vector3d> find_nipple(const BodyShape& body, const Eigen::Vector3d& apex);

}  // namespace tensegric_fit::landmarks
