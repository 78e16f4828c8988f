/// A unit's resistance to a change of its own volume, as tissue has it that is full of water. Ours; the
/// papers keep the volume of a region only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"
#include "tensegric/unit_prism.hpp"

namespace tensegric_fit::tensegric {

/// With V its volume it adds the energy 1/2 stiffness V0 (V / V0 - 1)^2.
struct UnitPressure {
  std::array<int, 6> nodes;  ///< the upper triangle's, then those below them
  Eigen::Vector3d origin;    ///< its centre at rest: volumes are summed from here
  double rest;               ///< volume at rest, m^3
  double stiffness;          ///< pseudo force / m^2
};

/// One a unit that can move, none where the model has no stiffness of volume, and none of units that are
/// flat or turned inside out at rest.
std::vector<UnitPressure> unit_pressures(const Model& model, const std::vector<int>& free_index);

double pressure_energy(const std::vector<UnitPressure>& units, const Positions& x);

/// Add the energy's first and second derivative by the free nodes, with `whole` of the part of the second one
/// that may be negative.
void add_pressure_gradient(const std::vector<UnitPressure>& units, const Positions& x,
                           const std::vector<int>& free_index, Eigen::VectorXd& gradient);
void add_pressure_hessian(const std::vector<UnitPressure>& units, const Positions& x,
                          const std::vector<int>& free_index, NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
