/// How far one surface is from another.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::gauge {

/// The value that this share of all is below. \pre not empty
double quantile(std::vector<double> values, double share);

/// From some thousand of the points, evenly by their order, to the surface; metres. `left_out` is empty or
/// has one flag per point.
std::vector<double> distances(const std::vector<Eigen::Vector3d>& points, const std::vector<char>& left_out,
                              const geometry::TriangleMesh& surface);

}  // namespace tensegric_fit::gauge
