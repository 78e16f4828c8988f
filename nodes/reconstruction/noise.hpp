/// How noisy a scan is.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Standard deviation along the surface's normal, m: the median over some of the points of how far they and
/// their neighbours lie off their plane. \pre not empty
double noise_of(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
