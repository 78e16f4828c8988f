#include "tensegric/unit_pressure.hpp"

namespace tensegric_fit::tensegric {
namespace {

Corners corners_of(const UnitPressure& unit, const Positions& x) {
  return corners_from(unit.nodes, x, unit.origin);
}

double strain_of(const UnitPressure& unit, const Corners& corners) {
  return unit_volume(corners) / unit.rest - 1;
}

}  // namespace

std::vector<UnitPressure> unit_pressures(const Model& model, const std::vector<int>& free_index) {
  std::vector<UnitPressure> units;
  if (model.options.volume_stiffness == 0) return units;
  const Positions rest = model.rest_positions();
  std::size_t index = 0;
  for (const std::array<int, 6>& nodes : model.units()) {
    const double times = model.times[index++ % model.times.size()];
    if (!moves(nodes, free_index)) continue;
    UnitPressure unit{nodes, centre_of(nodes, rest), 0,
                      times * model.options.volume_stiffness * model.tissue};
    const Corners corners = corners_of(unit, rest);
    unit.rest = unit_volume(corners);
    if (unit.rest > kFlatUnit * upright_volume(corners)) units.push_back(unit);
  }
  return units;
}

double pressure_energy(const std::vector<UnitPressure>& units, const Positions& x) {
  double energy = 0;
  for (const UnitPressure& unit : units) {
    const double strain = strain_of(unit, corners_of(unit, x));
    energy += unit.stiffness * unit.rest * strain * strain / 2;
  }
  return energy;
}

void add_pressure_gradient(const std::vector<UnitPressure>& units, const Positions& x,
                           const std::vector<int>& free_index, Eigen::VectorXd& gradient) {
  for (const UnitPressure& unit : units) {
    const Corners corners = corners_of(unit, x), by_node = volume_gradient(corners);
    const double pressure = unit.stiffness * strain_of(unit, corners);
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) gradient.segment<3>(3 * row) += pressure * by_node[i];
    }
  }
}

void add_pressure_hessian(const std::vector<UnitPressure>& units, const Positions& x,
                          const std::vector<int>& free_index, NodeMatrix& hessian, double whole) {
  for (const UnitPressure& unit : units) {
    const Corners corners = corners_of(unit, x), by_node = volume_gradient(corners);
    const double pressure = whole * unit.stiffness * strain_of(unit, corners);
    const VolumeHessian second = volume_hessian(corners);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j)
        hessian.add(
            free_index[unit.nodes[i]], free_index[unit.nodes[j]],
            unit.stiffness / unit.rest * by_node[i] * by_node[j].transpose() + pressure * second[i][j]);
  }
}

}  // namespace tensegric_fit::tensegric
