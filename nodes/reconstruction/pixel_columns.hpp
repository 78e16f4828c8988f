/// The sensors of a cloud that does not name them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Number of the sensor that saw each point, from 0; -1 where none is known. A depth image's pixels are rays
/// in a regular grid: its points lie in planes through the sensor, one a column of pixels, evenly spaced in
/// the image, whatever the noise of their depth. A cloud keeps these planes as long as nobody merges, thins
/// by averages, or smooths it; of any other cloud no point gets a number. Columns of pixels must be within 5
/// degrees of upright. Deterministic.
std::vector<int> sensors_of(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
