/// Where the scan stands: its floor, or the plane that the body would come to rest on.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Takes the plane (unit normal, up) with normal . x = offset to z = 0, and the point of it under `middle` to
/// the origin. The turn is the smallest one.
Eigen::Isometry3d level(const Eigen::Vector3d& normal, double offset, const Eigen::Vector3d& middle);

/// The plane that the soles lie on, as an isometry like `level`'s: half way between the facet of all points'
/// convex hull that lies below the middle of the lowest ones (a scan that leans need not be in balance) and
/// the plane through the rims of the soles, by all low points. On 47 scans it leans by 0.2 to 1.8 degrees,
/// mostly backwards, the facet by up to 2.3. A facet steeper than 20 degrees is not believed; the lowest
/// point's level is taken then. \pre not empty, z roughly up
Eigen::Isometry3d resting_plane(const std::vector<Eigen::Vector3d>& points);

/// Height of the ground under level soles of which only the edges are seen, told from how fast points become
/// more from the lowest ones up: within 3.5 mm on 60 scans of 40,000 to 240,000 points, whatever their noise;
/// a stray point does not count. \pre z up
double ground_under(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
