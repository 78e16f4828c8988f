#include "control_mesh/grid.hpp"

namespace tensegric_fit::control_mesh {
namespace {

/// Cell between row and row + 1, column and column + 1: two triangles, counter-clockwise from outside.
void add_cell(const Template& pattern, int row, int column, std::vector<Eigen::Vector3i>& triangles) {
  const bool mirrored = column >= pattern.middle();
  const char drawn = pattern.diagonals[row][mirrored ? pattern.columns - 2 - column : column];
  const bool falling = (drawn == '\\') != mirrored;
  // Seen from outside her left, column 0, is on the viewer's right.
  const int upper = row * pattern.columns + column, lower = upper + pattern.columns;
  if (falling) {
    triangles.emplace_back(upper, upper + 1, lower + 1);
    triangles.emplace_back(upper, lower + 1, lower);
  } else {
    triangles.emplace_back(upper, upper + 1, lower);
    triangles.emplace_back(upper + 1, lower + 1, lower);
  }
}

}  // namespace

int node_at(const Template& pattern, int row, int column, Side side) {
  return row * pattern.columns + (side == Side::left ? column : pattern.columns - 1 - column);
}

std::string name_on(const std::string& name, Side side) {
  if (side == Side::left || name.size() < 3 || name[name.size() - 2] != '_') return name;
  const std::string stem = name.substr(0, name.size() - 1);
  return name.back() == 'L' ? stem + "R" : name.back() == 'R' ? stem + "L" : name;
}

geometry::ControlMesh grid_of(const Template& pattern) {
  geometry::ControlMesh grid;
  const std::size_t count = static_cast<std::size_t>(pattern.rows) * pattern.columns;
  grid.outer.resize(count, Eigen::Vector3d::Zero());
  grid.inner.resize(count, Eigen::Vector3d::Zero());
  grid.outer_fixed.resize(count, 0);
  grid.inner_fixed.resize(count, 0);
  grid.names.resize(count);
  for (const Side side : {Side::left, Side::right}) {
    for (int row = 0; row < pattern.rows; ++row)
      for (int column = 0; column <= pattern.middle(); ++column) {
        const int node = node_at(pattern, row, column, side);
        grid.outer_fixed[node] = pattern.fixed[row][column] == '#';
        grid.inner_fixed[node] = grid.outer_fixed[node] && pattern.inner_fixed;
      }
    for (const TemplateNode& node : pattern.nodes)
      grid.names[node_at(pattern, node.row, node.column, side)] = name_on(node.name, side);
  }

  for (int row = 0; row + 1 < pattern.rows; ++row)
    for (int column = 0; column + 1 < pattern.columns; ++column)
      add_cell(pattern, row, column, grid.triangles);
  for (const TemplateRegion& region : pattern.regions) {
    geometry::ControlRegion part{region.name, {}};
    for (int row = region.first_row; row < region.last_row; ++row)
      for (int column = region.first_column; column < region.last_column; ++column) {
        const int cell = row * (pattern.columns - 1) + column;
        part.triangles.push_back(2 * cell);
        part.triangles.push_back(2 * cell + 1);
      }
    grid.regions.push_back(std::move(part));
  }
  return grid;
}

}  // namespace tensegric_fit::control_mesh
