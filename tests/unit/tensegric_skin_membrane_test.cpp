#include "tensegric/skin_membrane.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tensegric_bust.hpp"
#include "tensegric_derivatives.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSkin = 0.06;             // m of tissue
constexpr double kArea = (10 * 6) * 9e-4;  // m^2, of the sheet
constexpr double kYoungThickness = kSkin;  // of skin, as tissue's stiffness is 1

/// The bust's triangles over a flat grid of 30 mm.
Model sheet() {
  Model model;
  model.control = bust_mesh();
  for (std::size_t i = 0; i < model.control.outer.size(); ++i)
    model.control.outer[i] = Vector3d(0.03 * (i % 11), 0.03 * (i / 11), 0);
  model.options.skin = kSkin;
  return model;
}

double energy_of(const Model& model, const Matrix3d& by) {
  Positions x = model.control.outer;
  for (Vector3d& p : x) p = by * p + Vector3d(1, 2, 3);
  return skin_energy(skin_triangles(model, std::vector<int>(x.size(), 0)), x);
}

// Pulled along one way and free to become narrower it has Young's modulus, with half of the strain across.
TEST(SkinMembrane, IsElasticAndIncompressible) {
  constexpr double kStrain = 1e-4;
  const Matrix3d turn = Eigen::AngleAxisd(1.3, Vector3d(1, -2, 1).normalized()).toRotationMatrix();
  for (const double angle : {0.0, 0.7, 2.0})
    for (const double strain : {kStrain, -kStrain}) {  // skin pushes, too
      const Matrix3d way = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
      const Matrix3d stretch = way * Vector3d(1 + strain, 1 - strain / 2, 1).asDiagonal() * way.transpose();
      EXPECT_NEAR(energy_of(sheet(), turn * stretch) / kArea, kYoungThickness * strain * strain / 2,
                  5 * kYoungThickness * std::pow(kStrain, 3));
    }
}

TEST(SkinMembrane, TurnsAndBendsFreely) {
  const Model model = sheet();
  const Matrix3d turn = Eigen::AngleAxisd(2.0, Vector3d(-1, 1, 3).normalized()).toRotationMatrix();
  EXPECT_LE(std::abs(energy_of(model, turn)), 1e-13 * kArea);
  Positions folded = model.control.outer;
  for (Vector3d& p : folded)
    if (p.y() > 0.09) p = Vector3d(p.x(), 0.09, p.y() - 0.09);  // along a row of the grid
  EXPECT_LE(std::abs(skin_energy(skin_triangles(model, std::vector<int>(folded.size(), 0)), folded)),
            1e-13 * kArea);
}

TEST(SkinMembrane, DerivativesAreThoseOfItsEnergy) {
  ModelOptions options;
  options.inner = InnerNodes::bound;
  options.skin = kSkin;
  const Model model = build_model(bust_mesh(), options);
  const std::vector<SkinTriangle> skin = skin_triangles(model, model.free_index());
  ASSERT_GT(skin.size(), 60U);
  expect_derivatives(model, skin, pairs_within(skin, model.free_index()), skin_energy, add_skin_gradient,
                     [](const auto& of, const Positions& x, const std::vector<int>& index,
                        NodeMatrix& hessian) { add_skin_hessian(of, x, index, hessian); });
}

TEST(SkinMembrane, OnlyWhereThereIsSkinThatMoves) {
  Model model = sheet();
  EXPECT_EQ(skin_triangles(model, std::vector<int>(model.control.outer.size(), -1)).size(), 0U);
  model.options.skin = 0;
  EXPECT_EQ(skin_triangles(model, std::vector<int>(model.control.outer.size(), 0)).size(), 0U);
  model.options.skin = kSkin;
  model.options.uniform = true;  // the papers' parts
  EXPECT_EQ(skin_triangles(model, std::vector<int>(model.control.outer.size(), 0)).size(), 0U);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
