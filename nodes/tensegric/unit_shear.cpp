#include "tensegric/unit_shear.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "tensegric/unit_prism.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Gradients = Eigen::Matrix<double, 6, 3>;

// Gauss points, exact for the unit's volume and its derivatives: three in the triangle (barycentric 2/3, 1/6,
// 1/6) at two depths.
constexpr double kNear = 2.0 / 3, kFar = 1.0 / 6;
const double kDepth = std::sqrt(1.0 / 3) / 2;  // of the unit's depth, from its middle

// Derivatives of the corners' shape functions by the two sides of the triangle and by depth, upwards.
Gradients local_gradients(const Vector3d& barycentric, double up) {
  Gradients local;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d in_plane =
        i == 0 ? Eigen::Vector2d(-1, -1) : Eigen::Vector2d(Eigen::Vector2d::Unit(i - 1));
    local.row(i) << (0.5 + up) * in_plane.transpose(), barycentric[i];
    local.row(i + 3) << (0.5 - up) * in_plane.transpose(), -barycentric[i];
  }
  return local;
}

Corners corners_of(const UnitShear& unit, const Positions& x) {
  return corners_from(unit.nodes, x, unit.origin);
}

// q, its first derivative, and how much stiffer the tissue is.
struct Shear {
  double q;
  double by_volume;   // of the terms in J
  Corners of_volume;  // derivative of the volume
  Corners by_node;
  double times;
};

Shear shear_of(const UnitShear& unit, const Corners& corners) {
  Shear shear;
  shear.of_volume = volume_gradient(corners);
  double volume = 0;  // homogeneous of degree 3: a third of x . gradient
  for (int i = 0; i < 6; ++i) volume += corners[i].dot(shear.of_volume[i]) / 3;
  const double strain = volume / unit.rest - 1;
  shear.q = -3 - 2 * strain + strain * strain;
  shear.by_volume = 2 * (strain - 1) / unit.rest;
  for (int i = 0; i < 6; ++i) {
    Vector3d sum = Vector3d::Zero();
    for (int j = 0; j < 6; ++j) sum += unit.form(i, j) * corners[j];
    shear.q += corners[i].dot(sum);
    shear.by_node[i] = shear.by_volume * shear.of_volume[i] + 2 * sum;
  }
  shear.times = 1 + unit.stiffening / 3 * shear.q;
  return shear;
}

// The form, and false where the unit is flat or inside out at one of the points.
bool take_form(const Corners& corners, double least_volume, UnitShear& unit) {
  unit.form.setZero();
  Eigen::Matrix<double, 3, 6> places;
  for (int i = 0; i < 6; ++i) places.col(i) = corners[i];
  double sum = 0;
  for (const double up : {-kDepth, kDepth})
    for (int k = 0; k < 3; ++k) {
      Vector3d barycentric = Vector3d::Constant(kFar);
      barycentric[k] = kNear;
      const Gradients local = local_gradients(barycentric, up);
      const Matrix3d jacobian = places * local;
      const double volume = jacobian.determinant() / 12;  // half of a triangle's, at six points
      if (!(volume > least_volume / 6)) return false;
      const Gradients gradients = local * jacobian.inverse();
      unit.form += volume * gradients * gradients.transpose();
      sum += volume;
    }
  unit.form /= sum;
  return true;
}

}  // namespace

std::vector<UnitShear> unit_shears(const Model& model, const std::vector<int>& free_index) {
  std::vector<UnitShear> units;
  if (model.options.shear_stiffness == 0) return units;
  const Positions rest = model.rest_positions();
  std::size_t index = 0;
  for (const std::array<int, 6>& nodes : model.units()) {
    const double times = model.times[index++ % model.times.size()];
    if (!moves(nodes, free_index)) continue;
    UnitShear unit{nodes, {}, centre_of(nodes, rest), 0, 0, model.options.stiffening};
    const Corners corners = corners_of(unit, rest);
    unit.rest = unit_volume(corners);
    if (!take_form(corners, kFlatUnit * upright_volume(corners), unit)) continue;
    unit.stiffness = times * model.options.shear_stiffness * model.tissue * unit.rest;
    units.push_back(unit);
  }
  return units;
}

double shear_energy(const std::vector<UnitShear>& units, const Positions& x) {
  double energy = 0;
  for (const UnitShear& unit : units) {
    const double q = shear_of(unit, corners_of(unit, x)).q;
    energy += unit.stiffness * q * (1 + unit.stiffening / 6 * q) / 2;
  }
  return energy;
}

void add_shear_gradient(const std::vector<UnitShear>& units, const Positions& x,
                        const std::vector<int>& free_index, Eigen::VectorXd& gradient) {
  for (const UnitShear& unit : units) {
    const Shear shear = shear_of(unit, corners_of(unit, x));
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) gradient.segment<3>(3 * row) += unit.stiffness * shear.times / 2 * shear.by_node[i];
    }
  }
}

void add_shear_hessian(const std::vector<UnitShear>& units, const Positions& x,
                       const std::vector<int>& free_index, NodeMatrix& hessian, double whole) {
  for (const UnitShear& unit : units) {
    const Corners corners = corners_of(unit, x);
    const Shear shear = shear_of(unit, corners);
    const VolumeHessian second = volume_hessian(corners);
    const double half = unit.stiffness / 2, whole_shear = half * shear.times;
    const double by_volume = 2 * whole_shear / (unit.rest * unit.rest), by_q = half * unit.stiffening / 3;
    for (int i = 0; i < 6; ++i) {
      const Vector3d of_volume = by_volume * shear.of_volume[i], of_q = by_q * shear.by_node[i];
      for (int j = 0; j <= i; ++j) {
        Matrix3d block = of_volume * shear.of_volume[j].transpose() + of_q * shear.by_node[j].transpose();
        if (i != j) block += cross_matrix(whole * whole_shear * shear.by_volume * second[i][j]);
        block.diagonal().array() += 2 * whole_shear * unit.form(i, j);
        hessian.add(free_index[unit.nodes[i]], free_index[unit.nodes[j]], block);
      }
    }
  }
}

}  // namespace tensegric_fit::tensegric
