/// What keeps a unit from turning inside out: without it a strong request folds the skin over itself. Ours;
/// the papers' struts let a triangle pass through its unit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// The tetrahedron of a unit's upper triangle and the centroid of its lower one, or of the lower triangle and
/// the upper centroid. With s its volume / that at rest and s0 = 0.7, it adds the energy
/// -stiffness (s - s0)^2 ln(s / s0) while s < s0: nothing above s0, two continuous derivatives, and no bound
/// as s goes to zero.
struct UnitVolume {
  std::array<int, 6> nodes;  ///< the triangle's corners, then those whose mean is the apex
  double rest;               ///< 6 times the volume at rest, m^3, negative for a lower triangle
  double stiffness;          ///< pseudo force times length
};

/// Two a unit that can move. Units that are flat or turned inside out at rest have none.
std::vector<UnitVolume> unit_volumes(const Model& model, const std::vector<int>& free_index);

/// Volume / volume at rest.
double volume_share(const UnitVolume& unit, const Positions& x);

/// Infinite where a unit is turned inside out.
double fold_energy(const std::vector<UnitVolume>& units, const Positions& x);

/// Add the energy's first and second derivative by the free nodes, with `whole` of the part of the second one
/// that may be negative. \pre the energy is finite
void add_fold_gradient(const std::vector<UnitVolume>& units, const Positions& x,
                       const std::vector<int>& free_index, Eigen::VectorXd& gradient);
void add_fold_hessian(const std::vector<UnitVolume>& units, const Positions& x,
                      const std::vector<int>& free_index, NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
