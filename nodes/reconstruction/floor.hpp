/// The floor under a scan.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace tensegric_fit::reconstruction {

struct Floor {
  Eigen::Vector3d normal;  ///< unit, up
  double offset;           ///< normal . x = offset on the floor
  double noise;            ///< standard deviation of its points, m
};

/// How far over a floor its own points reach, m: four of their deviations, 4 to 8 mm.
double reach_of_floor(double noise);

/// The plane, within 20 degrees of level, that carries the lowest points of most 30 mm columns; none where
/// fewer than 0.1 m^2 of columns agree or more than a few lie below it. \pre finite points, z roughly up
std::optional<Floor> find_floor(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
