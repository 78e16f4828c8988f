/// Forces of struts and tensile parts, and the energy that they come from (P1 §3.1; README.md):
/// E = sum over tensile parts 1/2 k/l0 max(0, l - d)^2 + sum over struts 1/2 k/l0 (l - h)^2
///     + sum over struts and extended tensile parts 1/4 k c l0 e^4, e = l/l0 - 1: they stiffen with strain.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// Force / elongation at rest.
inline double spring(const Member& m) {
  return m.stiffness / m.rest;
}

/// The strain that a member stiffens with: struts both ways, tensile parts where they are longer than at
/// rest.
inline double stiffening_strain(const Member& m, double length) {
  const double strain = length / m.rest - 1;
  return m.strut || strain > 0 ? strain : 0;
}

/// Pull along the member at `length`: negative in a strut that is pressed, zero in a tensile part that is
/// slack.
inline double tension(const Member& m, double length) {
  const double force = spring(m) * (length - m.natural);
  if (!m.strut && !(force > 0)) return 0;
  const double strain = stiffening_strain(m, length);
  return force + m.stiffness * m.stiffening * strain * strain * strain;
}

/// Its derivative by the length, of a member that is not slack.
inline double tangent(const Member& m, double length) {
  const double strain = stiffening_strain(m, length);
  return spring(m) * (1 + 3 * m.stiffening * strain * strain);
}

/// The spring from its natural length that would pull as a tensile part does that is not slack.
inline double secant(const Member& m, double length) {
  const double strain = stiffening_strain(m, length);
  if (strain == 0) return spring(m);
  return spring(m) + m.stiffness * m.stiffening * strain * strain * strain / (length - m.natural);
}

double member_energy(const Model& model, const Positions& x);

/// Adds the energy's gradient by the free nodes (see Model::free_index). Each node's net force is its
/// negative.
void add_member_gradient(const Model& model, const Positions& x, const std::vector<int>& free_index,
                         Eigen::VectorXd& gradient);

/// Adds the energy's second derivative, with `whole` of what pressed struts take away from it: 0 leaves it
/// positive semi-definite.
void add_member_hessian(const Model& model, const Positions& x, const std::vector<int>& free_index,
                        NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
