#include "tensegric/unit_shear.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "tensegric/unit_pressure.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Shares = std::array<double, 6>;

// Two edges of the middle triangle and the mean way from lower to upper corners, as sums of the corners.
constexpr double kThird = 1.0 / 3;
constexpr std::array<Shares, 3> kSides = {{{-0.5, 0.5, 0, -0.5, 0.5, 0},
                                           {-0.5, 0, 0.5, -0.5, 0, 0.5},
                                           {kThird, kThird, kThird, -kThird, -kThird, -kThird}}};

Vector3d sum_of(const Shares& shares, const UnitShear& unit, const Positions& x) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 6; ++i) sum += shares[i] * x[unit.nodes[i]];
  return sum;
}

// F way as a sum of the corners: the sides at rest, solved for it.
Shares shares_of(const Matrix3d& sides, const Vector3d& way) {
  const Vector3d c = sides.inverse() * way;
  Shares shares;
  for (int i = 0; i < 6; ++i) shares[i] = c[0] * kSides[0][i] + c[1] * kSides[1][i] + c[2] * kSides[2][i];
  return shares;
}

}  // namespace

std::vector<UnitShear> unit_shears(const Model& model, const std::vector<int>& free_index) {
  std::vector<UnitShear> units;
  if (model.options.shear_stiffness == 0) return units;
  const Positions rest = model.rest_positions();
  std::size_t index = 0;
  for (const std::array<int, 6>& nodes : model.units()) {
    const double times = model.times[index++ % model.times.size()];
    UnitShear unit{nodes, {}, {}, 0};
    bool moves = false;
    std::array<Vector3d, 6> corners;
    for (int i = 0; i < 6; ++i) {
      corners[i] = rest[nodes[i]];
      moves = moves || free_index[nodes[i]] >= 0;
    }
    Matrix3d sides;
    for (int k = 0; k < 3; ++k) sides.col(k) = sum_of(kSides[k], unit, rest);
    const Vector3d across = sides.col(0).cross(sides.col(1));
    const double area = across.norm() / 2, depth = sides.col(2).norm(), volume = sides.determinant() / 2;
    if (!moves || !(volume > kFlatUnit * area * depth)) continue;
    const Vector3d n = across.normalized(), t = sides.col(0).normalized();
    unit.normal = shares_of(sides, n);
    unit.tangent = {shares_of(sides, t), shares_of(sides, n.cross(t))};
    unit.stiffness = times * model.options.shear_stiffness * model.tissue * volume;
    units.push_back(unit);
  }
  return units;
}

double shear_energy(const std::vector<UnitShear>& units, const Positions& x) {
  double energy = 0;
  for (const UnitShear& unit : units) {
    const Vector3d normal = sum_of(unit.normal, unit, x);
    for (const Shares& tangent : unit.tangent) {
      const double shear = normal.dot(sum_of(tangent, unit, x));
      energy += unit.stiffness * shear * shear / 2;
    }
  }
  return energy;
}

void add_shear_gradient(const std::vector<UnitShear>& units, const Positions& x,
                        const std::vector<int>& free_index, Eigen::VectorXd& gradient) {
  for (const UnitShear& unit : units) {
    const Vector3d normal = sum_of(unit.normal, unit, x);
    for (const Shares& tangent : unit.tangent) {
      const Vector3d along = sum_of(tangent, unit, x);
      const double force = unit.stiffness * normal.dot(along);
      for (int i = 0; i < 6; ++i) {
        const int row = free_index[unit.nodes[i]];
        if (row >= 0) gradient.segment<3>(3 * row) += force * (unit.normal[i] * along + tangent[i] * normal);
      }
    }
  }
}

void add_shear_hessian(const std::vector<UnitShear>& units, const Positions& x,
                       const std::vector<int>& free_index, NodeMatrix& hessian, double whole) {
  for (const UnitShear& unit : units) {
    const Vector3d normal = sum_of(unit.normal, unit, x);
    std::array<std::array<Vector3d, 6>, 2> first;
    std::array<double, 2> force;
    for (int k = 0; k < 2; ++k) {
      const Vector3d along = sum_of(unit.tangent[k], unit, x);
      force[k] = whole * unit.stiffness * normal.dot(along);
      for (int i = 0; i < 6; ++i) first[k][i] = unit.normal[i] * along + unit.tangent[k][i] * normal;
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) {
        Matrix3d block = Matrix3d::Zero();
        for (int k = 0; k < 2; ++k) {
          block += unit.stiffness * first[k][i] * first[k][j].transpose();
          block.diagonal().array() +=
              force[k] * (unit.normal[i] * unit.tangent[k][j] + unit.tangent[k][i] * unit.normal[j]);
        }
        hessian.add(free_index[unit.nodes[i]], free_index[unit.nodes[j]], block);
      }
  }
}

}  // namespace tensegric_fit::tensegric
