/// The points of a scan that are the body's.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Indices of the largest thing in the scan, without stray points; spatially ordered, so that neighbours lie
/// close in memory too. \pre finite points within a few metres, floor removed
std::vector<int> body_points(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
