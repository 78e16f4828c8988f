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

/// Adds the energy's first derivative by the free nodes. \pre the energy is finite
void add_fold_gradient(const std::vector<UnitVolume>& units, const Positions& x,
                       const std::vector<int>& free_index, Eigen::VectorXd& gradient);

/// Each barrier's push (its energy's slope by the share, negative: never below zero) as a straight line in
/// the share, for a Newton step.
struct StraightPush {
  int unit;
  double share;  ///< of volume, at `x`
  double push;   ///< where the line touches the barrier's curve; 0: of a unit that will not push
  double at_x;   ///< on the line
  double slope;  ///< of the line, negative
};

/// One of each unit that pushes. The line touches the curve at the unit's own share, or, where `pushes` (one
/// a unit, none where empty) is positive, at the share that has this push. The push begins with the square of
/// (s0 - s), and Newton's method on a square only halves the distance in each step: with a unit that is
/// nearly flat at rest, and so pushes with many times what acts on it, this takes ten steps and more. The
/// push that a step foresees is nearly right, so the next line is laid there (the primal-dual view of a
/// barrier: J. Nocedal, S. J. Wright, "Numerical Optimization", 2006, ch. 19). Where it is below zero, but by
/// less than the unit pushes at its own share, the unit pushes nothing in the next step; by more, it says
/// only that the last line was laid too far away, and the line touches at the unit's own share.
std::vector<StraightPush> straight_pushes(const std::vector<UnitVolume>& units, const Positions& x,
                                          const Eigen::VectorXd& pushes = {});

/// Add to the first derivative by the free nodes what the lines push otherwise than the barriers, and the
/// second derivative with the lines for the barriers, with `whole` of the part that may be negative.
void add_straight_difference(const std::vector<UnitVolume>& units, const Positions& x,
                             const std::vector<StraightPush>& lines, const std::vector<int>& free_index,
                             Eigen::VectorXd& gradient);
void add_fold_hessian(const std::vector<UnitVolume>& units, const Positions& x,
                      const std::vector<StraightPush>& lines, const std::vector<int>& free_index,
                      NodeMatrix& hessian, double whole = 1);

/// What the lines push after `move` of the free nodes, by the shares' first derivatives; one per line.
Eigen::VectorXd pushes_after(const std::vector<UnitVolume>& units, const Positions& x,
                             const std::vector<StraightPush>& lines, const std::vector<int>& free_index,
                             const Eigen::VectorXd& move);

}  // namespace tensegric_fit::tensegric
