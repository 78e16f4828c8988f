/// The prism between a triangle and the one below it: its volume and the volume's derivatives.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tensegric/model.hpp"

namespace tensegric_fit::tensegric {

/// Volume over that of an upright unit, below which a unit resists neither a change of its volume nor shear:
/// its directions are rounding.
inline constexpr double kFlatUnit = 1e-3;

/// The upper triangle's, then those below them.
using Corners = std::array<Eigen::Vector3d, 6>;
/// Second derivatives by corner i, then by corner j < i: cross_matrix of [i][j]. A corner's own are zero.
using VolumeHessian = std::array<std::array<Eigen::Vector3d, 6>, 6>;

Eigen::Vector3d centre_of(const std::array<int, 6>& nodes, const Positions& x);

/// From `origin`: near the unit, so that little is rounded.
Corners corners_from(const std::array<int, 6>& nodes, const Positions& x, const Eigen::Vector3d& origin);

/// Whether one of its nodes is free.
bool moves(const std::array<int, 6>& nodes, const std::vector<int>& free_index);

/// m^3, each side face taken as the mean of its two foldings: the volume under the bilinear face.
double unit_volume(const Corners& corners);
Corners volume_gradient(const Corners& corners);
VolumeHessian volume_hessian(const Corners& corners);

/// Of an upright unit with the same upper triangle and mean depth, m^3.
double upright_volume(const Corners& corners);

}  // namespace tensegric_fit::tensegric
