/// From where the points of a surface can be seen.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// For each point the sum of the directions (from the point to a far eye) from which no other point hides it.
/// Its dot product with a normal is positive where that normal points out of the body: a hole shows the
/// inside from few directions only. \pre z up; the eyes look from all sides and above
std::vector<Eigen::Vector3d> seen_from(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
