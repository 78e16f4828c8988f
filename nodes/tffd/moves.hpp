/// The evaluation of t-FFD: what has to be quick.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tffd/weights.hpp"

namespace tensegric_fit::tffd {

/// Adds M times the nodes' motion to the anchors' positions. `weights` are the entries of M in its own order,
/// in the precision of Scalar: float or double. The positions are double either way, and displacements are a
/// few centimetres, so single precision is off by some 1e-8 m. \pre M is compressed
template <typename Scalar>
void add_moves(const SparseRows& nodes, const Scalar* weights, const std::vector<Eigen::Vector3d>& motion,
               const std::vector<Anchor>& anchors, std::vector<Eigen::Vector3d>& positions);

}  // namespace tensegric_fit::tffd
