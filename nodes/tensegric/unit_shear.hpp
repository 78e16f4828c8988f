/// A unit's resistance to a shift of its skin side against its bone side. Ours: struts alone resist it the
/// less the flatter a unit is, as they lie along the skin then.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// With F the unit's mean deformation, n the normal of its middle triangle at rest and t1, t2 perpendicular
/// to it, it adds the energy 1/2 stiffness V0 ((F t1 . F n)^2 + (F t2 . F n)^2): of small shears the elastic
/// one.
struct UnitShear {
  std::array<int, 6> nodes;                      ///< the upper triangle's, then those below them
  std::array<double, 6> normal;                  ///< F n as a sum of the corners, 1/m
  std::array<std::array<double, 6>, 2> tangent;  ///< F t1 and F t2, likewise
  double stiffness;                              ///< shear modulus times volume at rest, pseudo force m
};

/// One a unit that can move, none where the model has no stiffness of shear, and none of units that are flat.
std::vector<UnitShear> unit_shears(const Model& model, const std::vector<int>& free_index);

double shear_energy(const std::vector<UnitShear>& units, const Positions& x);

/// Add the energy's first and second derivative by the free nodes, with `whole` of the part of the second one
/// that may be negative.
void add_shear_gradient(const std::vector<UnitShear>& units, const Positions& x,
                        const std::vector<int>& free_index, Eigen::VectorXd& gradient);
void add_shear_hessian(const std::vector<UnitShear>& units, const Positions& x,
                       const std::vector<int>& free_index, NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
