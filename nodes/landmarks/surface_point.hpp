/// Extreme points of a piece of skin, found in spite of noise.
#pragma once

#include <vector>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// Vertices of the body inside a box, ascending.
std::vector<int> vertices_in_box(const BodyShape& body, const Eigen::Vector3d& low,
                                 const Eigen::Vector3d& high);

/// The point of `among` that reaches furthest along `direction`. \pre not empty
int furthest_vertex(const BodyShape& body, const std::vector<int>& among, const Eigen::Vector3d& direction);

/// Furthest point along `direction` of a smooth bulge near `start`: apex of the quadric fitted to the skin
/// within `radius`. Where the fit has no apex there, `start`.
Eigen::Vector3d apex_of_bulge(const BodyShape& body, const Eigen::Vector3d& start,
                              const Eigen::Vector3d& direction, double radius);

}  // namespace tensegric_fit::landmarks
