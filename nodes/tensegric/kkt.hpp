/// One Newton step on the conditions of balance: forces, volumes and bands together (README.md).
/// The second derivative is taken whole where that leads to a minimum, else with as much of its negative
/// parts (pressed struts, volumes, units about to fold) as does. With none of them everywhere, steps past a
/// point where the tissue snaps over were too short: 300 of them did not do what 14 do.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "tensegric/band_length.hpp"
#include "tensegric/front_factor.hpp"
#include "tensegric/node_matrix.hpp"
#include "tensegric/problem.hpp"

namespace tensegric_fit::tensegric {

/// What a band does at present.
enum class Hold {
  slack,    ///< shorter than neutral: pulls nothing
  length,   ///< steep: kept at the length that its law has for its tension (rigid: at its neutral length)
  elastic,  ///< not steep: pulls as its law has for its length
  limit     ///< pulls its tension limit, whatever its length
};

/// Positions and multipliers. Pressure pushes outward where it is positive.
struct Balance {
  Positions x;
  Eigen::VectorXd pressures;    ///< one per region, times its area: a force
  Eigen::VectorXd tensions;     ///< one per band
  std::vector<Hold> holds;      ///< one per band
  Eigen::VectorXd pushes = {};  ///< of units about to fold, as the last step foresaw them, below zero where
                                ///< it would have had them pull; zero, or empty: not foreseen
};

/// What is asked for: changes as the load is followed.
struct Load {
  std::vector<double> neutral;  ///< one per band, m
  std::vector<double> limit;    ///< one per band, pseudo force
  Eigen::Vector3d gravity;
};

/// Net forces and broken conditions at a balance.
struct KktResidual {
  Eigen::MatrixXd jacobian;    ///< gradients of the conditions by the free nodes, one per column
  Eigen::VectorXd gradient;    ///< of the Lagrangian by the free nodes
  Eigen::VectorXd conditions;  ///< regions (m: loss of volume / area), then bands (m, or a pseudo force)
  double residual = 0;         ///< largest net force / mean tensile force at rest
  double volume_error = 0;     ///< largest |dV / V|
  double length_error = 0;     ///< largest |L / l - 1| of the bands kept at length
  double tension_error = 0;    ///< largest error of the other bands' tensions / mean tensile force at rest
};

struct Step {
  Eigen::VectorXd move;             ///< by the free nodes
  Eigen::VectorXd multipliers;      ///< change of pressures, then of tensions
  std::vector<StraightPush> lines;  ///< of the units about to fold
  Eigen::VectorXd push_change;      ///< one per line
  Eigen::VectorXd left_over;        ///< of the conditions, as far as they contradict each other
  bool minimum = true;  ///< the balance is a minimum of the energy as far as the second derivative shows
};

class Kkt {
 public:
  explicit Kkt(const Problem& problem);

  KktResidual defect(const Balance& at, const Load& load) const;

  /// Newton's step. Where the second derivative is no minimum's, its negative parts are taken back until it
  /// is one's, so that the step leads downhill; with `to_saddle` it is left as it is. Not finite where there
  /// is no step. With `foreseen` units about to fold push as `at` foresees it.
  Step step(const Balance& at, const Load& load, const KktResidual& defect, bool to_saddle, bool foreseen);

  /// What remains to be done after a step, by the matrix of the last step, though by the conditions'
  /// gradients where `defect` is: its lines and pushes are none.
  Step step_again(const KktResidual& defect) const;

  /// A move of least effort that takes `conditions` to zero, by the matrix of the last step.
  Eigen::VectorXd correction(const Eigen::VectorXd& conditions) const;

  /// Factorisations so far: what a solution costs on a fine mesh.
  int factorisations() const { return factorisations_; }

  /// Energy of members, gravity and the bands that are not kept at length.
  double energy(const Balance& at, const Load& load) const;

  /// The multipliers that come nearest to balance at `at`, for the volumes and the bands kept at length.
  void guess_multipliers(Balance& at, const Load& load) const;

  /// The shortest move of the free nodes that takes `conditions` to zero at `defect`'s state.
  static Eigen::VectorXd shortest_move(const KktResidual& defect, const Eigen::VectorXd& conditions);

 private:
  void assemble(const Balance& at, const std::vector<StraightPush>& lines, double whole);
  bool factorise(const Balance& at, const Load& load, const KktResidual& defect,
                 const Eigen::VectorXd& gradient);
  void take_multipliers(const KktResidual& defect, const Eigen::VectorXd& free_move, Step& step) const;

  const Problem& problem_;
  int regions_, bands_;
  // What made the second derivative a minimum's, where it was not: the last raise of its diagonal / spring of
  // a part, and the last share of its negative parts that was taken back. Each is as small as will do: a long
  // shape that buckles has modes that much more of either would keep from moving.
  double raise_, taken_back_ = 1;
  int factorisations_ = 0;
  std::vector<LengthCurvature> curvatures_;  // one per band
  NodeMatrix hessian_;
  FrontFactor factor_;
  bool usable_ = false;                        // the last factorisation
  Eigen::MatrixXd solved_;                     // the conditions' gradients, solved for
  Eigen::VectorXd free_move_;                  // the step's gradient, solved for
  Eigen::VectorXd by_length_, by_multiplier_;  // each condition's derivatives
  Eigen::MatrixXd schur_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> schur_factor_;
};

}  // namespace tensegric_fit::tensegric
