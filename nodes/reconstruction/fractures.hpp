/// Motion fractures: body parts that were scanned in two places.
#pragma once

#include <vector>

#include "geometry/fracture.hpp"
#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

/// Places between ankles and neck where the points form two sheets that face the same way, at least 3 mm
/// apart and clearly farther than noise and the columns' registration put them elsewhere on this body; the
/// largest first. A part that moved along its own skin leaves no second sheet and is not found. \pre upright
/// body on z = 0, outward unit normals
std::vector<geometry::Fracture> find_fractures(const geometry::PointCloud& body);

}  // namespace tensegric_fit::reconstruction
