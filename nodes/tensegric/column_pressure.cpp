#include "tensegric/column_pressure.hpp"

#include <algorithm>

namespace tensegric_fit::tensegric {
namespace {

constexpr double kShare = 1.0 / 3;  // of a unit's volume, in each of its three columns

Corners corners_of(const Columns::Unit& unit, const Positions& x) {
  return corners_from(unit.nodes, x, unit.origin);
}

std::vector<double> unit_volumes_of(const Columns& columns, const Positions& x) {
  std::vector<double> volumes;
  volumes.reserve(columns.units.size());
  for (const Columns::Unit& unit : columns.units) volumes.push_back(unit_volume(corners_of(unit, x)));
  return volumes;
}

double strain_of(const Column& column, const std::vector<double>& volumes) {
  double volume = 0;
  for (const int unit : column.units) volume += kShare * volumes[unit];
  return volume / column.rest - 1;
}

// Derivative of the energy by each unit's volume.
std::vector<double> pressures_of_units(const Columns& columns, const Positions& x) {
  const std::vector<double> volumes = unit_volumes_of(columns, x);
  std::vector<double> of_units(columns.units.size(), 0.0);
  for (const Column& column : columns.columns) {
    const double pressure = kShare * column.stiffness * strain_of(column, volumes);
    for (const int unit : column.units) of_units[unit] += pressure;
  }
  return of_units;
}

void number_nodes(const Columns& columns, const std::vector<int>& free_index, Column& column) {
  for (const int unit : column.units)
    for (const int node : columns.units[unit].nodes)
      if (free_index[node] >= 0) column.nodes.push_back(free_index[node]);
  std::sort(column.nodes.begin(), column.nodes.end());
  column.nodes.erase(std::unique(column.nodes.begin(), column.nodes.end()), column.nodes.end());
  for (const int unit : column.units) {
    column.at_node.emplace_back();
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[columns.units[unit].nodes[i]];
      const auto place = std::lower_bound(column.nodes.begin(), column.nodes.end(), row);
      column.at_node.back()[i] = row < 0 ? -1 : static_cast<int>(place - column.nodes.begin());
    }
  }
}

}  // namespace

Columns columns_of(const Model& model, const std::vector<int>& free_index) {
  Columns columns;
  if (model.options.volume_stiffness == 0) return columns;
  const Positions rest = model.rest_positions();
  std::vector<Column> of_node(rest.size());  // by its upper node
  std::size_t index = 0;
  for (const std::array<int, 6>& nodes : model.units()) {
    const double times = model.times[index++ % model.times.size()];
    const Columns::Unit unit{nodes, centre_of(nodes, rest)};
    const Corners corners = corners_of(unit, rest);
    const double volume = unit_volume(corners);
    if (!(volume > kFlatUnit * upright_volume(corners))) continue;
    for (int i = 0; i < 3; ++i) {
      Column& column = of_node[nodes[i]];
      column.units.push_back(static_cast<int>(columns.units.size()));
      column.rest += kShare * volume;
      column.stiffness += kShare * volume * times * model.options.volume_stiffness * model.tissue;
    }
    columns.units.push_back(unit);
  }
  for (Column& column : of_node) {
    if (column.units.empty()) continue;
    column.stiffness /= column.rest;
    number_nodes(columns, free_index, column);
    if (!column.nodes.empty()) columns.columns.push_back(std::move(column));
  }
  return columns;
}

double pressure_energy(const Columns& columns, const Positions& x) {
  const std::vector<double> volumes = unit_volumes_of(columns, x);
  double energy = 0;
  for (const Column& column : columns.columns) {
    const double strain = strain_of(column, volumes);
    energy += column.stiffness * column.rest * strain * strain / 2;
  }
  return energy;
}

void add_pressure_gradient(const Columns& columns, const Positions& x, const std::vector<int>& free_index,
                           Eigen::VectorXd& gradient) {
  const std::vector<double> of_units = pressures_of_units(columns, x);
  for (std::size_t k = 0; k < of_units.size(); ++k) {
    const Columns::Unit& unit = columns.units[k];
    const Corners by_node = volume_gradient(corners_of(unit, x));
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) gradient.segment<3>(3 * row) += of_units[k] * by_node[i];
    }
  }
}

void add_pressure_hessian(const Columns& columns, const Positions& x, const std::vector<int>& free_index,
                          NodeMatrix& hessian, double whole) {
  const std::vector<double> of_units = pressures_of_units(columns, x);
  std::vector<Corners> gradients;
  gradients.reserve(of_units.size());
  for (std::size_t k = 0; k < of_units.size(); ++k) {
    const Columns::Unit& unit = columns.units[k];
    const Corners corners = corners_of(unit, x);
    gradients.push_back(volume_gradient(corners));
    const VolumeHessian second = volume_hessian(corners);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j)  // a node's own is zero
        hessian.add(free_index[unit.nodes[i]], free_index[unit.nodes[j]],
                    cross_matrix(whole * of_units[k] * second[i][j]));
  }
  std::vector<Eigen::Vector3d> by_node;
  for (const Column& column : columns.columns) {
    by_node.assign(column.nodes.size(), Eigen::Vector3d::Zero());
    for (std::size_t k = 0; k < column.units.size(); ++k)
      for (int i = 0; i < 6; ++i)
        if (column.at_node[k][i] >= 0) by_node[column.at_node[k][i]] += gradients[column.units[k]][i];
    hessian.add_outer(column.nodes, by_node, kShare * kShare * column.stiffness / column.rest);
  }
}

}  // namespace tensegric_fit::tensegric
