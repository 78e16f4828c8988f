/// The points of a scan that are the body's.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Indices of the points in neighbourhoods of a few centimetres that hold at least a tenth of what the median
/// point's does; spatially ordered. \pre not empty, finite points within a few metres
std::vector<int> without_stray(const std::vector<Eigen::Vector3d>& points);

/// Things that are some centimetres apart: indices of the points of each, those with the most points first.
/// \pre not empty, finite points within a few metres
std::vector<std::vector<int>> things_in(const std::vector<Eigen::Vector3d>& points);

/// Indices of the thing in the scan with the most points that `may_be_her`, as a wall is not, else with the
/// most of all; without stray points; spatially ordered, so that neighbours lie close in memory too.
/// \pre finite points within a few metres, floor removed
std::vector<int> body_points(const std::vector<Eigen::Vector3d>& points,
                             const std::function<bool(const std::vector<Eigen::Vector3d>&)>& may_be_her);

}  // namespace tensegric_fit::reconstruction
