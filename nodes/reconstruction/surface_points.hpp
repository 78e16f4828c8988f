/// Points that belong to no surface, in scans with many of them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// Indices of all points; or, where more than a tenth look stray, of the others. A stray point's neighbours
/// fill space, or lie much farther from it than is usual within some centimetres. Good scans keep every
/// point, since hair, fingers and grazing views look stray too. \pre finite points within a few metres
std::vector<int> surface_points(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::reconstruction
