#include "tensegric/members.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::tensegric {

double member_energy(const Model& model, const Positions& x) {
  double energy = 0;
  for (const Member& m : model.members) {
    const double length = (x[m.a] - x[m.b]).norm();
    const double elongation = m.strut ? length - m.natural : std::max(0.0, length - m.natural);
    const double strain = stiffening_strain(m, length);
    energy += spring(m) * elongation * elongation / 2 +
              m.stiffness * m.stiffening * m.rest * strain * strain * strain * strain / 4;
  }
  return energy;
}

void add_member_gradient(const Model& model, const Positions& x, const std::vector<int>& free_index,
                         Eigen::VectorXd& gradient) {
  for (const Member& m : model.members) {
    const Eigen::Vector3d span = x[m.a] - x[m.b];
    const double length = span.norm();
    const double force = tension(m, length);
    if (force == 0 || length == 0) continue;
    const Eigen::Vector3d pull = force / length * span;
    if (free_index[m.a] >= 0) gradient.segment<3>(3 * free_index[m.a]) += pull;
    if (free_index[m.b] >= 0) gradient.segment<3>(3 * free_index[m.b]) -= pull;
  }
}

void add_member_hessian(const Model& model, const Positions& x, const std::vector<int>& free_index,
                        NodeMatrix& hessian, double whole) {
  for (const Member& m : model.members) {
    const int a = free_index[m.a], b = free_index[m.b];
    if (a < 0 && b < 0) continue;
    const Eigen::Vector3d span = x[m.a] - x[m.b];
    const double length = span.norm();
    const double force = tension(m, length);
    if (length == 0 || (force == 0 && !m.strut)) continue;
    const Eigen::Vector3d u = span / length;
    const double across = (force > 0 ? 1 : whole) * force / length;
    Eigen::Matrix3d block = (tangent(m, length) - across) * u * u.transpose();
    block.diagonal().array() += across;
    hessian.add(a, a, block);
    hessian.add(b, b, block);
    hessian.add(a, b, -block);
  }
}

}  // namespace tensegric_fit::tensegric
