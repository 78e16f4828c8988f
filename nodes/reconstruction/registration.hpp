/// Sensors that are off against each other.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Moves each sensor's points as one rigid body, so that sensors agree where they see the same skin: least
/// squares of the distance between their sheets, along the skin's normal; fractures do not count. The mean of
/// all motions is zero, since nothing fixes where the whole is. Points without a sensor (-1) stay, and those
/// of sensors that share hardly any skin with others, as of one in front and one behind; so do all where a
/// sensor would move by more than 10 mm, or none by as much as 0.4 mm: these were registered before.
void register_sensors(std::vector<Eigen::Vector3d>& points, std::vector<int> sensor_of);

}  // namespace tensegric_fit::reconstruction
