/// How far one surface is from another, and how differently it is turned.
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

/// Angle between the normal at a vertex of `mesh` and the one of `surface` at the nearest place, smooth
/// normals both; degrees. Vertices and `left_out` as the points above.
std::vector<double> normal_angles(const geometry::TriangleMesh& mesh, const std::vector<char>& left_out,
                                  const geometry::TriangleMesh& surface);

}  // namespace tensegric_fit::gauge
