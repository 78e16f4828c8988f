#include "tensegric/unit_pressure.hpp"

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

TEST(UnitPressure, DerivativesAreThoseOfItsEnergy) {
  const Model model = build_model(bust_mesh(), stiff_tissue(3));
  const std::vector<UnitPressure> units = unit_pressures(model, model.free_index());
  ASSERT_GT(units.size(), 60U);
  expect_derivatives(model, units, pressure_energy, add_pressure_gradient,
                     [](const auto& of, const Positions& x, const std::vector<int>& index,
                        NodeMatrix& hessian) { add_pressure_hessian(of, x, index, hessian); });
}

// A unit that leans so far that it is nearly flat resists nothing: where it holds less than a thousandth of
// an upright one.
TEST(UnitPressure, NearlyFlatUnitsHaveNone) {
  for (const double share : {0.8e-3, 0.95e-3, 1.05e-3, 1.2e-3}) {
    geometry::ControlMesh control = bust_mesh();
    constexpr double kDepth = 0.02;  // m, of the edges from upper to lower corners
    for (std::size_t i = 0; i < control.outer.size(); ++i) {
      control.outer[i] = Vector3d(0.03 * (i % 11), 0.03 * (i / 11), 0);
      const double height = share * kDepth;
      control.inner[i] = control.outer[i] - Vector3d(std::sqrt(kDepth * kDepth - height * height), 0, height);
    }
    Model model;
    model.control = control;
    model.options = stiff_tissue(1);
    model.times.assign(control.triangles.size(), 1);
    const std::size_t moving = unit_pressures(model, std::vector<int>(2 * control.outer.size(), 0)).size();
    EXPECT_EQ(moving, share > 1e-3 ? control.triangles.size() : 0) << share;
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

TEST(UnitPressure, KeepsUnitsNearTheirOwnVolumes) {
  const double loose = volume_change(0), firm = volume_change(1), firmer = volume_change(10);
  EXPECT_LT(firm, 0.9 * loose);
  EXPECT_LT(firmer, 0.7 * firm);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
