/// The sensors of a cloud that does not name them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Per point; both empty where no sensor is known.
struct Sightings {
  std::vector<int> sensor;               ///< that saw it, from 0; -1 where none is known
  std::vector<Eigen::Vector3d> towards;  ///< level unit vector towards that sensor; zero where none is known
};

/// Which sensor saw each point. A depth image's pixels are rays in a regular grid: its points lie in planes
/// through the sensor, one a column of pixels, evenly spaced in the image, whatever the noise of their depth.
/// A cloud keeps these planes as long as nobody merges, thins by averages, or smooths it. Columns of pixels
/// must be within 5 degrees of upright. Deterministic.
Sightings sightings_of(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
