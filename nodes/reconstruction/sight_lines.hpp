/// Gaps between limbs that one can look through.
#pragma once

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

/// Points on the unseen strips beside narrow upright gaps: between thighs, between arm and trunk. Where a
/// level line of sight passes between two limbs it passes through air, so that the skin beside it runs
/// straight from the nearest point seen in front to the nearest point seen behind. Without them the
/// reconstruction closes such gaps with a web, and the crotch comes too low. Thighs that touch show no gap
/// and stay joined there. \pre upright body, outward unit normals
geometry::PointCloud sight_line_points(const geometry::PointCloud& body);

}  // namespace tensegric_fit::reconstruction
