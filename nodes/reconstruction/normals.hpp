/// Outward normals of a body's points.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::reconstruction {

/// One unit normal per point, outward. The line of each is that of the plane through its neighbours; its sign
/// follows its neighbours and, for the patch as a whole, `hints`: normals from the scanner (zero where
/// unknown; turned over if they point inwards on the whole), or, for points without one, the side from which
/// they can be seen from afar. `outward`: hints are known to be. \pre upright body, z up
std::vector<Eigen::Vector3d> outward_normals(const std::vector<Eigen::Vector3d>& points,
                                             const std::vector<Eigen::Vector3d>& hints, bool outward = false);

}  // namespace tensegric_fit::reconstruction
