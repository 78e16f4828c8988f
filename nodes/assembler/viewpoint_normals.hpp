/// Normals of what one sensor saw.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::assembler {

/// One unit normal per point: of the plane through its neighbours, towards the side from which it was seen.
/// \pre finite points, all seen from `viewpoint`
std::vector<Eigen::Vector3d> viewpoint_normals(const std::vector<Eigen::Vector3d>& points,
                                               const Eigen::Vector3d& viewpoint);

}  // namespace tensegric_fit::assembler
