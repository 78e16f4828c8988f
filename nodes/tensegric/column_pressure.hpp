/// Resistance to changes of volume, as tissue has it that is full of water: by the mean over the units round
/// each node in a layer, not unit by unit. Units that each kept their own volume could hardly bend (locking).
/// Averages of volume: J. Bonet, A. J. Burton, "A simple average nodal pressure tetrahedral element for
/// incompressible and nearly incompressible dynamic explicit applications", 1998. Ours; the papers keep the
/// volume of a region only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"
#include "tensegric/unit_prism.hpp"

namespace tensegric_fit::tensegric {

/// The units of one layer that share a node and the one below it, each with a third of its volume. With V
/// their volume it adds the energy 1/2 stiffness V0 (V / V0 - 1)^2.
struct Column {
  std::vector<int> units;                   ///< see Columns
  std::vector<int> nodes;                   ///< free ones, numbered as in the matrix
  std::vector<std::array<int, 6>> at_node;  ///< of each unit's corners, where in `nodes` it is, or -1
  double rest = 0;                          ///< volume at rest, m^3
  double stiffness = 0;                     ///< pseudo force / m^2
};

struct Columns {
  struct Unit {
    std::array<int, 6> nodes;  ///< the upper triangle's, then those below them
    Eigen::Vector3d origin;    ///< its centre at rest: volumes are summed from here
  };
  std::vector<Unit> units;
  std::vector<Column> columns;
};

/// None where the model has no stiffness of volume. Without units that are flat or turned inside out at rest,
/// and without columns that cannot move.
Columns columns_of(const Model& model, const std::vector<int>& free_index);

double pressure_energy(const Columns& columns, const Positions& x);

/// Add the energy's first and second derivative by the free nodes, with `whole` of the part of the second one
/// that may be negative.
void add_pressure_gradient(const Columns& columns, const Positions& x, const std::vector<int>& free_index,
                           Eigen::VectorXd& gradient);
void add_pressure_hessian(const Columns& columns, const Positions& x, const std::vector<int>& free_index,
                          NodeMatrix& hessian, double whole = 1);

}  // namespace tensegric_fit::tensegric
