/// Fewer points where a surface is smooth.
#pragma once

#include <array>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

/// One point for all that lie in one cube, their mean, or with `by_sensor` one for each sensor's; the mean of
/// their normals where there are any (zero stays unknown). \pre finite points within a few metres
geometry::PointCloud merged(const geometry::PointCloud& cloud, double cube, bool by_sensor = false);

/// Means of the points in cubes of 2.5 mm where the skin bends strongly (fingers, ears, nose), 5 mm where it
/// bends, 10 mm where it is smooth; points of two sides of a gap in one cube stay as they are. The first come
/// three times and the second twice, since a scanner's points lie no closer than that: an octree that follows
/// the density of points then has small cells only where they are needed. Outside of the heights `fine`
/// (lowest and highest, m) all skin gets 10 mm. \pre unit normals
geometry::PointCloud thinned(const geometry::PointCloud& cloud, const std::array<double, 2>& fine);

}  // namespace tensegric_fit::reconstruction
