/// A force that means the same on every shape: by what it would do to it (fit --gravity).
#pragma once

#include <vector>

#include "tensegric/problem.hpp"

namespace tensegric_fit::tensegric {

/// Of a shape's size, the diagonal of the box around its outer nodes: how far the unit of force moves it.
inline constexpr double kMoveOfUnit = 0.1;

/// The pseudo force on each outer node that `share` stands for: in its direction, and `share`'s length times
/// the force that would move the node that goes farthest by kMoveOfUnit of the shape's size, if the shape
/// gave way all along as it does at rest. Shapes that bend get stiffer or softer: up to about 1 this is near,
/// beyond it the force still grows in proportion. `options` as for solve, but for the gravity; `body_volumes`
/// as for solve. Zero for zero. \throw Refusal as solve; bad_option: `share` is not finite, or nothing gives
/// way in its direction
Eigen::Vector3d force_of_share(const Model& model, const Eigen::Vector3d& share, SolverOptions options,
                               const std::vector<PosedVolume>& body_volumes = {});

}  // namespace tensegric_fit::tensegric
