/// Prestress: force densities that balance the undeformed model (P2 §2.1, README.md).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/model.hpp"

namespace tensegric_fit::tensegric {

/// Force density (force / length) of each member: pulls at every tensile part (nothing at some of them only
/// where there is no balance else), pushes or nothing at every strut, and no net force at any free node. The
/// nearest such densities to those of the ideal prism, an affine image of which stands on each triangle: base
/// and top 1/sqrt(3), lateral 1, strut -1, summed where units share a part: `ideal` has their sizes, one a
/// member. Each piece of the control mesh is balanced by itself; only ratios within it mean anything.
/// \throw Refusal bad_mesh: no such densities exist
Eigen::VectorXd force_densities(const Model& model, const std::vector<double>& ideal);

}  // namespace tensegric_fit::tensegric
