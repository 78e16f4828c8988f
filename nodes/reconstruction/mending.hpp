/// Body parts that sensors saw in several places.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Where the sheets of several sensors part on a piece of skin because she moved between one sensor's turn
/// and another's, gives each sensor a smooth field of shifts, zero away from there, after which they agree:
/// the skin comes to lie between the places where it was seen, and keeps its girths. Points without a sensor
/// (-1) stay. Returns whether any moved. \pre one unit normal and one sensor per point, upright body on z = 0
bool mend_fractures(std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& normals,
                    const std::vector<int>& sensor_of);

}  // namespace tensegric_fit::reconstruction
