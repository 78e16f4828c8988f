/// The soles, which no sensor sees.
#pragma once

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

/// Points on z = 0, a few millimetres apart, inside the outlines that the points below 30 mm draw seen from
/// above: with normals straight down they end the reconstruction flat on the ground, where it would bulge.
/// None where nothing is that low.
geometry::PointCloud sole_points(const std::vector<Eigen::Vector3d>& body);

}  // namespace tensegric_fit::reconstruction
