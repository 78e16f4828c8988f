#include "tensegric/unit_shear.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"
#include "tensegric_derivatives.hpp"

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
  model.options.stiffening = 0;
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

// Of small strains e it is G e : e V, in all directions alike; turning costs nothing.
TEST(UnitShear, IsIsotropicAndTurnsFreely) {
  const Model model = sheet(0.02);
  const std::vector<UnitShear> units = unit_shears(model, all_free(model));
  const double volume = 0.3 * 0.18 * 0.02;
  const Matrix3d turn = Eigen::AngleAxisd(2.0, Vector3d(-1, 1, 3).normalized()).toRotationMatrix();
  EXPECT_LE(std::abs(shear_energy(units, moved(model.rest_positions(), turn))), 1e-13 * volume);
  for (const Vector3d& axis : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(1, 2, -1)}) {
    constexpr double kStrain = 1e-4;
    const Vector3d way = axis.normalized();
    const Matrix3d stretch = Matrix3d::Identity() + kStrain * way * way.transpose();
    EXPECT_NEAR(shear_energy(units, moved(model.rest_positions(), turn * stretch)) / volume,
                kShearStiffness * kStrain * kStrain, 2 * kShearStiffness * std::pow(kStrain, 3));
  }
}

// Pulled by a strain e at a constant volume it is 1 + stiffening e^2 times as stiff.
TEST(UnitShear, StiffensAsMembersDo) {
  Model model = sheet(0.02);
  const auto energy = [&](double strain) {
    const double across = 1 / std::sqrt(1 + strain);
    return shear_energy(unit_shears(model, all_free(model)),
                        moved(model.rest_positions(), Vector3d(1 + strain, across, across).asDiagonal()));
  };
  constexpr double kStrain = 0.01, kStiffening = 300;
  const double without = energy(kStrain);
  model.options.stiffening = kStiffening;
  // The energy's share of e^4 is half of the stiffness's of e^2.
  EXPECT_NEAR(energy(kStrain) / without - 1, kStiffening * kStrain * kStrain / 2,
              0.03 * kStiffening * kStrain * kStrain);
}

// However a unit is deformed, also inside out: else a step of the solver could run away.
TEST(UnitShear, IsNeverNegative) {
  const Model model = sheet(0.02);
  const std::vector<UnitShear> units = unit_shears(model, all_free(model));
  const Positions rest = model.rest_positions();
  for (const double across : {-2.0, -0.3, 0.0, 0.2, 0.7, 1.5, 4.0, 30.0})
    for (const double along : {0.1, 0.6, 1.0, 1.7, 9.0})
      EXPECT_GE(shear_energy(units, moved(rest, Vector3d(along, along, across).asDiagonal())), -1e-15);
}

TEST(UnitShear, DerivativesAreThoseOfItsEnergy) {
  ModelOptions options;
  options.inner = InnerNodes::bound;
  options.shear_stiffness = kShearStiffness;
  const Model model = build_model(bust_mesh(), options);
  const std::vector<UnitShear> units = unit_shears(model, model.free_index());
  ASSERT_GT(units.size(), 60U);
  expect_derivatives(model, units, pairs_within(units, model.free_index()), shear_energy, add_shear_gradient,
                     [](const auto& of, const Positions& x, const std::vector<int>& index,
                        NodeMatrix& hessian) { add_shear_hessian(of, x, index, hessian); });
}

// Three layers of one sheet shear like one: struts alone cannot do that, as they lie flatter in each.
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
  EXPECT_NEAR(energies[1] / energies[0], 1, 1e-10);
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
