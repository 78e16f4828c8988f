#include "control_mesh/grid.hpp"

#include <algorithm>

#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

/// The mark of the cell between row and row + 1, column and column + 1 of the whole grid, as drawn.
char mark_of(const Template& pattern, int row, int column) {
  return pattern.diagonals[row][column < pattern.middle() ? column : pattern.columns - 2 - column];
}

/// Two triangles a cell, counter-clockwise from outside, or none.
void add_cell(const Template& pattern, int row, int column, std::vector<Eigen::Vector3i>& triangles) {
  const char mark = mark_of(pattern, row, column);
  if (mark == ' ') return;
  const bool falling = (mark == '\\') == (column < pattern.middle());
  // Seen from outside her left, column 0, is on the viewer's right.
  const int* upper = &pattern.numbers[row * pattern.columns + column];
  const int* lower = upper + pattern.columns;
  if (falling) {
    triangles.emplace_back(upper[0], upper[1], lower[1]);
    triangles.emplace_back(upper[0], lower[1], lower[0]);
  } else {
    triangles.emplace_back(upper[0], upper[1], lower[0]);
    triangles.emplace_back(upper[1], lower[1], lower[0]);
  }
}

}  // namespace

std::vector<int> number_nodes(const Template& pattern) {
  std::vector<int> numbers(static_cast<std::size_t>(pattern.rows) * pattern.columns, -1);
  for (int row = 0; row + 1 < pattern.rows; ++row)
    for (int column = 0; column + 1 < pattern.columns; ++column) {
      if (mark_of(pattern, row, column) == ' ') continue;
      const int corner = row * pattern.columns + column;
      for (int place : {corner, corner + 1, corner + pattern.columns, corner + pattern.columns + 1})
        numbers[place] = 0;
    }
  int next = 0;
  for (int& number : numbers)
    if (number == 0) number = next++;
  return numbers;
}

int node_at(const Template& pattern, int row, int column, Side side) {
  return pattern
      .numbers[row * pattern.columns + (side == Side::left ? column : pattern.columns - 1 - column)];
}

std::string name_on(const std::string& name, Side side) {
  if (side == Side::left || name.size() < 3 || name[name.size() - 2] != '_') return name;
  const std::string stem = name.substr(0, name.size() - 1);
  return name.back() == 'L' ? stem + "R" : name.back() == 'R' ? stem + "L" : name;
}

geometry::ControlMesh grid_of(const Template& pattern) {
  geometry::ControlMesh grid;
  const int count = 1 + *std::max_element(pattern.numbers.begin(), pattern.numbers.end());
  grid.outer.resize(count, Eigen::Vector3d::Zero());
  grid.inner.resize(count, Eigen::Vector3d::Zero());
  grid.outer_fixed.resize(count, 0);
  grid.inner_fixed.resize(count, 0);
  grid.names.resize(count);
  for (const Side side : {Side::left, Side::right}) {
    for (int row = 0; row < pattern.rows; ++row)
      for (int column = 0; column <= pattern.middle(); ++column) {
        const int node = node_at(pattern, row, column, side);
        if (node < 0) continue;
        const char held = pattern.fixed[row][column];
        grid.outer_fixed[node] = held == '#';
        grid.inner_fixed[node] = held == 'o' || (held == '#' && pattern.inner_fixed);
      }
    for (const TemplateNode& node : pattern.nodes)
      grid.names[node_at(pattern, node.row, node.column, side)] = name_on(node.name, side);
  }

  for (const TemplateRegion& region : pattern.regions) grid.regions.push_back({region.name, {}});
  for (int row = 0; row + 1 < pattern.rows; ++row)
    for (int column = 0; column + 1 < pattern.columns; ++column) {
      const int first = static_cast<int>(grid.triangles.size());
      add_cell(pattern, row, column, grid.triangles);
      for (std::size_t i = 0; i < grid.regions.size(); ++i) {
        const TemplateRegion& region = pattern.regions[i];
        if (row < region.first_row || row >= region.last_row || column < region.first_column ||
            column >= region.last_column)
          continue;
        for (int t = first; t < static_cast<int>(grid.triangles.size()); ++t)
          grid.regions[i].triangles.push_back(t);
      }
    }
  return grid;
}

std::string where_of(const Template& pattern, const TemplateNode& node) {
  return "the template " + pattern.name + ", row " + std::to_string(node.row) + ", column " +
         std::to_string(node.column);
}

void check_together(const std::vector<Template>& patterns) {
  constexpr int kLeastHeld = 3;
  std::vector<geometry::ControlMesh> grids;
  for (const Template& pattern : patterns) {
    grids.push_back(grid_of(pattern));
    geometry::ControlMesh& grid = grids.back();
    for (const TemplateLine& line : pattern.lines) grid.lines.push_back({line.name, {}});
    if (!pattern.bone) continue;  // tissue may hold all inner nodes: the solver counts them
    const auto held = std::count(grid.inner_fixed.begin(), grid.inner_fixed.end(), 1);
    if (held < kLeastHeld)
      throw geometry::Refusal(geometry::refusal::kBadTemplate,
                              "the template " + pattern.name + " holds " + std::to_string(held) +
                                  " inner nodes: the surface of its 'bone' runs through three or more");
  }
  geometry::joined(grids);
}

}  // namespace tensegric_fit::control_mesh
