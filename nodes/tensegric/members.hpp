/// Forces of struts and tensile parts, and the energy that they come from (P1 §3.1; DESIGN §4):
/// E = sum over tensile parts 1/2 k/l0 max(0, l - d)^2 + sum over struts 1/2 k/l0 (l - h)^2.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// Force / elongation.
inline double spring(const Member& m) {
  return m.stiffness / m.rest;
}

/// Pull along the member at `length`: negative in a strut that is pressed, zero in a tensile part that is
/// slack.
inline double tension(const Member& m, double length) {
  const double force = spring(m) * (length - m.natural);
  return m.strut || force > 0 ? force : 0;
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
