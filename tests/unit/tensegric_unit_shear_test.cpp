#include "tensegric/unit_shear.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kShearStiffness = 0.7;

// A sheet of units `height` deep over a grid of 30 mm.
Model sheet(double height) {
  geometry::ControlMesh control = bust_mesh();
  for (std::size_t i = 0; i < control.outer.size(); ++i) {
    control.outer[i] = Vector3d(0.03 * (i % 11), 0.03 * (i / 11), 0);
    control.inner[i] = control.outer[i] - height * Vector3d::UnitZ();
  }
  Model model;
  model.control = control;
  model.options.shear_stiffness = kShearStiffness;
  model.times.assign(control.triangles.size(), 1);
  return model;
}

std::vector<int> all_free(const Model& model) {
  std::vector<int> index(model.nodes());
  for (int i = 0; i < model.nodes(); ++i) index[i] = i;
  return index;
}

Positions moved(const Positions& rest, const Matrix3d& by) {
  Positions x = rest;
  for (Vector3d& p : x) p = by * p + Vector3d(0.1, -0.2, 0.3);
  return x;
}

// Of a shear by an angle whose tangent is g the elastic energy is 1/2 G g^2 V, whatever the units' height and
// the direction along the skin.
TEST(UnitShear, IsElasticWhateverTheHeight) {
  for (const double height : {0.002, 0.02, 0.1})
    for (const double angle : {0.0, 0.4, 1.9}) {
      const Model model = sheet(height);
      const std::vector<UnitShear> units = unit_shears(model, all_free(model));
      ASSERT_EQ(units.size(), model.control.triangles.size());
      constexpr double kShear = 0.1;
      Matrix3d shear = Matrix3d::Identity();
      shear.col(2) += kShear * Vector3d(std::cos(angle), std::sin(angle), 0);
      const Matrix3d turned = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()) * shear;
      const double volume = 0.3 * 0.18 * height;  // of 10 by 6 cells
      EXPECT_NEAR(shear_energy(units, moved(model.rest_positions(), turned)),
                  kShearStiffness * volume * kShear * kShear / 2, 1e-12 * volume);
    }
}

TEST(UnitShear, ResistsNeitherTurnsNorWhatKeepsTheAngle) {
  const Model model = sheet(0.02);
  const std::vector<UnitShear> units = unit_shears(model, all_free(model));
  Matrix3d stretched = Vector3d(1.2, 0.9, 0.7).asDiagonal();
  stretched(0, 1) = 0.2;  // along the skin
  const Matrix3d turned = Eigen::AngleAxisd(2.0, Vector3d(-1, 1, 3).normalized()) * stretched;
  EXPECT_LE(shear_energy(units, moved(model.rest_positions(), turned)), 1e-25);
}

TEST(UnitShear, DerivativesAreThoseOfItsEnergy) {
  ModelOptions options;
  options.inner = InnerNodes::bound;
  options.shear_stiffness = kShearStiffness;
  const Model model = build_model(bust_mesh(), options);
  const std::vector<int> free_index = model.free_index();
  const std::vector<UnitShear> units = unit_shears(model, free_index);
  ASSERT_GT(units.size(), 60U);
  std::vector<std::pair<int, int>> pairs;
  for (const UnitShear& unit : units)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j)
        if (free_index[unit.nodes[i]] >= 0 && free_index[unit.nodes[j]] >= 0)
          pairs.emplace_back(free_index[unit.nodes[i]], free_index[unit.nodes[j]]);
  const unsigned seed = std::random_device{}();
  const testing::ScopedTrace trace{__FILE__, __LINE__, "seed " + std::to_string(seed)};
  std::mt19937 random{seed};
  std::normal_distribution<double> normal(0, 1);
  const int rows = 3 * model.free_nodes();
  const Eigen::VectorXd direction =
      Eigen::VectorXd::NullaryExpr(rows, [&](Eigen::Index) { return normal(random); });
  Positions x = model.rest_positions();
  const auto stepped = [&](double step) {
    Positions y = x;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (free_index[i] >= 0) y[i] += step * direction.segment<3>(3 * free_index[i]);
    return y;
  };
  x = stepped(0.003);
  const auto gradient = [&](const Positions& y) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(rows);
    add_shear_gradient(units, y, free_index, g);
    return g;
  };
  constexpr double kStep = 1e-6;  // m; the third derivative and rounding then stay below 1e-7 of the result
  const double slope =
      (shear_energy(units, stepped(kStep)) - shear_energy(units, stepped(-kStep))) / (2 * kStep);
  EXPECT_NEAR(gradient(x).dot(direction), slope, 1e-6 * std::abs(slope));
  NodeMatrix hessian(model.free_nodes(), pairs);
  add_shear_hessian(units, x, free_index, hessian);
  const Eigen::VectorXd change = (gradient(stepped(kStep)) - gradient(stepped(-kStep))) / (2 * kStep);
  const Eigen::VectorXd product = hessian.lower().selfadjointView<Eigen::Lower>() * direction;
  EXPECT_LE((change - product).norm(), 1e-6 * change.norm());
}

// Three layers of one sheet shear like one: what the lattice alone cannot do, whose struts lie flatter in
// each.
TEST(UnitShear, IsTheSameInLayers) {
  Model model = sheet(0.02);
  Matrix3d shear = Matrix3d::Identity();
  shear(0, 2) = 0.1;
  double energies[2];
  for (const int layers : {1, 3}) {
    model.options.layers = layers;
    energies[layers == 3] =
        shear_energy(unit_shears(model, all_free(model)), moved(model.rest_positions(), shear));
  }
  EXPECT_NEAR(energies[1] / energies[0], 1, 1e-12);
}

TEST(UnitShear, NearlyFlatUnitsHaveNone) {
  for (const double share : {0.8e-3, 1.2e-3}) {
    constexpr double kDepth = 0.02;  // m, of the edges from upper to lower corners
    Model model = sheet(kDepth);
    for (std::size_t i = 0; i < model.control.outer.size(); ++i)
      model.control.inner[i] =
          model.control.outer[i] - kDepth * Vector3d(std::sqrt(1 - share * share), 0, share);
    EXPECT_EQ(unit_shears(model, all_free(model)).size(),
              share > kFlatUnit ? model.control.triangles.size() : 0)
        << share;
  }
}

// Skin that a force draws sideways moves less the stiffer its units are against shear.
TEST(UnitShear, HoldsSkinBack) {
  double moves[2];
  for (const double stiffness : {0.0, 3.0}) {
    ModelOptions options;
    options.shear_stiffness = stiffness;
    const Model model = build_model(bust_mesh(), options);
    SolverOptions pulled;
    pulled.gravity = Vector3d(0.01, 0, 0);
    const Solution solution = solve(model, Garment{}, pulled);
    EXPECT_EQ(solution.status, Status::converged) << solution.note;
    double far = 0;
    for (std::size_t i = 0; i < solution.outer.size(); ++i)
      far = std::max(far, (solution.outer[i] - model.control.outer[i]).norm());
    moves[stiffness > 0] = far;
  }
  EXPECT_LT(moves[1], 0.8 * moves[0]);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
