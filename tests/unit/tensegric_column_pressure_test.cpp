#include "tensegric/column_pressure.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"
#include "tensegric_derivatives.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

TEST(UnitVolume, OfAnUprightAndALeaningPrism) {
  const std::array<Vector3d, 6> upright = {Vector3d(0, 0, 2), {1, 0, 2}, {0, 1, 2},
                                           {0, 0, 0},         {1, 0, 0}, {0, 1, 0}};
  EXPECT_NEAR(unit_volume(upright), 1, 1e-15);
  std::array<Vector3d, 6> leaning = upright;
  for (int i = 0; i < 3; ++i) leaning[i] += Vector3d(0.7, -0.3, 0);  // Cavalieri
  EXPECT_NEAR(unit_volume(leaning), 1, 1e-15);
}

TEST(UnitVolume, IsTheSameOfAMirroredUnit) {
  std::array<Vector3d, 6> unit = {Vector3d(0, 0, 2), {1, 0.2, 2},   {0, 1, 1.5},
                                  {0.1, 0, 0},       {1.2, 0, 0.3}, {0, 0.8, 0}};
  const double volume = unit_volume(unit);
  for (Vector3d& p : unit) p.x() = -p.x();
  std::swap(unit[0], unit[1]);
  std::swap(unit[3], unit[4]);
  EXPECT_NEAR(unit_volume(unit), volume, 1e-15);
}

ModelOptions stiff_tissue(double volume_stiffness) {
  ModelOptions options;
  options.inner = InnerNodes::bound;
  options.volume_stiffness = volume_stiffness;
  return options;
}

NodePairs pairs_of(const Columns& columns) {
  NodePairs pairs;
  for (const Column& column : columns.columns)
    for (std::size_t i = 1; i < column.nodes.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(column.nodes[i], column.nodes[j]);
  return pairs;
}

TEST(ColumnPressure, DerivativesAreThoseOfItsEnergy) {
  for (const int layers : {1, 3}) {
    ModelOptions options = stiff_tissue(3);
    options.layers = layers;
    const Model model = build_model(bust_mesh(), options);
    const Columns columns = columns_of(model, model.free_index());
    ASSERT_GT(columns.columns.size(), 60U * layers);
    expect_derivatives(model, columns, pairs_of(columns), pressure_energy, add_pressure_gradient,
                       [](const auto& of, const Positions& x, const std::vector<int>& index,
                          NodeMatrix& hessian) { add_pressure_hessian(of, x, index, hessian); });
  }
}

// A flat sheet of upright units, 20 mm deep over a grid of 30 mm.
Model flat_sheet() {
  Model model;
  model.control = bust_mesh();
  for (std::size_t i = 0; i < model.control.outer.size(); ++i) {
    model.control.outer[i] = Vector3d(0.03 * (i % 11), 0.03 * (i / 11), 0);
    model.control.inner[i] = model.control.outer[i] - Vector3d(0, 0, 0.02);
  }
  model.options = stiff_tissue(5);
  model.times.assign(model.control.triangles.size(), 1);
  return model;
}

std::vector<int> every_node_free(const Model& model) {
  std::vector<int> index(model.nodes());
  for (int i = 0; i < model.nodes(); ++i) index[i] = i;
  return index;
}

// Where all tissue swells alike the energy is 1/2 K V e^2, as that of units one by one is.
TEST(ColumnPressure, IsThatOfTheWholeVolumeWhereTissueSwellsAlike) {
  const Model model = flat_sheet();
  const Columns columns = columns_of(model, every_node_free(model));
  Positions x = model.rest_positions();
  for (Vector3d& p : x) p.z() *= 1.1;
  const double volume = 0.3 * 0.18 * 0.02;
  EXPECT_NEAR(pressure_energy(columns, x), 5 * volume * 0.1 * 0.1 / 2, 1e-12 * volume);
}

// One column of nodes moves along the sheet: units on one side swell, those on the other shrink, and columns
// that hold both keep their volume. That costs less than half of what it would unit by unit.
TEST(ColumnPressure, LetsUnitsOfOneColumnExchangeVolume) {
  const Model model = flat_sheet();
  const Columns columns = columns_of(model, every_node_free(model));
  const int middle = 3 * 11 + 5;  // of the sheet's 11 by 7 nodes
  Positions x = model.rest_positions();
  x[middle] += Vector3d(0.003, 0, 0);
  x[middle + 77] += Vector3d(0.003, 0, 0);
  double by_unit = 0;
  const Positions rest = model.rest_positions();
  for (const std::array<int, 6>& nodes : model.units()) {
    const double before = unit_volume(corners_from(nodes, rest, Vector3d::Zero()));
    const double after = unit_volume(corners_from(nodes, x, Vector3d::Zero()));
    by_unit += 5 * before * (after / before - 1) * (after / before - 1) / 2;
  }
  EXPECT_GT(by_unit, 0);
  EXPECT_LT(pressure_energy(columns, x), by_unit / 2);
}

// A unit that leans so far that it is nearly flat resists nothing: where it holds less than a thousandth of
// an upright one.
TEST(ColumnPressure, NearlyFlatUnitsHaveNone) {
  for (const double share : {0.8e-3, 0.95e-3, 1.05e-3, 1.2e-3}) {
    Model model = flat_sheet();
    constexpr double kDepth = 0.02;  // m, of the edges from upper to lower corners
    for (std::size_t i = 0; i < model.control.outer.size(); ++i) {
      const double height = share * kDepth;
      model.control.inner[i] =
          model.control.outer[i] - Vector3d(std::sqrt(kDepth * kDepth - height * height), 0, height);
    }
    const std::size_t moving = columns_of(model, every_node_free(model)).units.size();
    EXPECT_EQ(moving, share > 1e-3 ? model.control.triangles.size() : 0) << share;
  }
}

// Root of the mean square relative change of the units' volumes under the chest line at 0.95.
double volume_change(double volume_stiffness) {
  const Model model = build_model(bust_mesh(), stiff_tissue(volume_stiffness));
  Garment garment;
  garment.lines.push_back({"chest", 0.95, {}, std::numeric_limits<double>::infinity(), {}, false});
  const Solution solution = solve(model, garment, {});
  EXPECT_EQ(solution.status, Status::converged);
  const Positions before = model.rest_positions();
  Positions after = solution.outer;
  after.insert(after.end(), solution.inner.begin(), solution.inner.end());
  const int count = static_cast<int>(solution.outer.size());
  double sum = 0;
  for (const Eigen::Vector3i& t : model.control.triangles) {
    const auto volume = [&](const Positions& x) {
      return unit_volume({x[t[0]], x[t[1]], x[t[2]], x[t[0] + count], x[t[1] + count], x[t[2] + count]});
    };
    const double change = volume(after) / volume(before) - 1;
    sum += change * change;
  }
  return std::sqrt(sum / static_cast<double>(model.control.triangles.size()));
}

TEST(ColumnPressure, KeepsVolumesNearWhatTheyWere) {
  const double loose = volume_change(0), firm = volume_change(1), firmer = volume_change(10);
  EXPECT_LT(firm, 0.9 * loose);
  EXPECT_LT(firmer, 0.7 * firm);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
