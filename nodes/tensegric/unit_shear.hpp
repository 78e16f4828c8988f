/// A unit's resistance to shear, the same in all directions. Ours: struts and tensile parts alone resist it
/// by where they happen to lie, and the less the flatter a unit is.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// With F the deformation gradient in the unit, of corners to which it is linear in each direction, J its
/// volume over that at rest, and q = mean |F|^2 - 3 - 2 (J - 1) + (J - 1)^2, it adds the energy 1/2 stiffness
/// (q + stiffening / 6 q^2). q is never negative, 0 where the unit turns only, and of small strains e twice
/// the mean of e : e, so that stiffness / V0 is the shear modulus; pulled by a strain of e at a constant
/// volume q is 3 e^2, and the tissue 1 + stiffening e^2 times as stiff, as members are.
struct UnitShear {
  std::array<int, 6> nodes;          ///< the upper triangle's, then those below them
  Eigen::Matrix<double, 6, 6> form;  ///< mean |F|^2 as a quadratic form of the corners, 1/m^2
  Eigen::Vector3d origin;            ///< its centre at rest: volumes are summed from here
  double rest;                       ///< volume at rest, m^3
  double stiffness;                  ///< shear modulus times volume at rest, pseudo force m
  double stiffening;                 ///< see ModelOptions
};

/// One a unit that can move, none where the model has no stiffness of shear, and none of units that are flat
/// or turned inside out somewhere.
std::vector<UnitShear> unit_shears(const Model& model, const std::vector<int>& free_index);

double shear_energy(const std::vector<UnitShear>& units, const Positions& x);

/// Add the energy's first and second derivative by the free nodes, with `whole` of the part of the second one
/// that may be negative.
void add_shear_gradient(const std::vector<UnitShear>& units, const Positions& x,
                        const std::vector<int>& free_index, Eigen::VectorXd& gradient);
void add_shear_hessian(const std::vector<UnitShear>& units, const Positions& x,
                       const std::vector<int>& free_index, NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
