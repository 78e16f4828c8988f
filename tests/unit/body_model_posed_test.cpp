// The posed model against itself: its derivatives, its frames, its sides.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "body_model/posed_model.hpp"
#include "body_model/registration.hpp"
#include "shipped_model.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

/// Somebody in some pose, somewhere.
Parameters random_woman(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  Parameters p(model());
  p.rotation = Eigen::AngleAxisd(normal(random), vector().normalized()).toRotationMatrix();
  p.position = vector();
  p.log_scale = 0.1 * normal(random);
  for (std::size_t g = 0; g < p.turns.size(); ++g)
    p.turns[g] = model().groups[g].spread.cwiseProduct(vector());
  for (double& c : p.shape) c = normal(random);
  return p;
}

TEST(PosedModel, DerivativesAreThoseOfFiniteDifferences) {
  for (const std::uint32_t seed : {1, 2, 3}) {
    const Parameters p = random_woman(seed);
    const PosedModel posed(model(), p);
    Eigen::Matrix3Xd derivative(3, p.count());
    for (int k = 0; k < p.count(); ++k) {
      // Vertices depend on the shape linearly, in float32 (1e-7 of 0.1 m): a long step. Else errors are some
      // step^2.
      const double h = k >= p.shape_at() ? 1.0 : 1e-5, allowed = k >= p.shape_at() ? 1e-6 : 1e-7;
      Eigen::VectorXd step = Eigen::VectorXd::Zero(p.count());
      step[k] = h;
      const Parameters ahead = p.plus(step), behind = p.plus(-step);
      const PosedModel there(model(), ahead), back(model(), behind);
      for (int v = k % 7; v < static_cast<int>(model().mean.size()); v += 601) {
        posed.derivative(v, derivative);
        const Vector3d expected = (there.vertex(v) - back.vertex(v)) / (2 * h);
        ASSERT_LT((derivative.col(k) - expected).norm(), allowed)
            << "seed " << seed << ", parameter " << k << ", vertex " << v;
      }
    }
  }
}

TEST(PosedModel, OfADerivativeAtRestToo) {  // where a turn has no axis yet
  const Parameters p(model());
  const PosedModel posed(model(), p);
  Eigen::Matrix3Xd derivative(3, p.count());
  for (int k = Parameters::kTurns; k < p.shape_at(); ++k) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(p.count());
    step[k] = 1e-5;
    const Parameters ahead = p.plus(step), behind = p.plus(-step);
    const PosedModel there(model(), ahead), back(model(), behind);
    for (int v = 0; v < static_cast<int>(model().mean.size()); v += 997) {
      posed.derivative(v, derivative);
      ASSERT_LT((derivative.col(k) - (there.vertex(v) - back.vertex(v)) / 2e-5).norm(), 1e-8)
          << "parameter " << k << ", vertex " << v;
    }
  }
}

TEST(PosedModel, AtRestIsTheMean) {
  const Parameters p(model());
  const PosedModel posed(model(), p);
  const Vector3d root = posed.joint(0);
  EXPECT_LT(root.norm(), 1e-12);
  const std::vector<Vector3d> vertices = posed.vertices();
  ASSERT_EQ(vertices.size(), model().mean.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    ASSERT_LT((vertices[v] - (model().mean[v] - model().inner_mean[0])).norm(), 1e-6)
        << v;  // weights are float32
    ASSERT_LT((vertices[v] - posed.vertex(static_cast<int>(v))).norm(), 1e-12) << v;
  }
}

TEST(PosedModel, ARigidMotionAndASizeMoveAllAlike) {
  const Parameters p = random_woman(5);
  Parameters moved = p;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  moved.rotation = turn * p.rotation;
  moved.position = Vector3d(0.3, -4, 1);
  moved.log_scale += std::log(1.2);
  const PosedModel before(model(), p), after(model(), moved);
  const auto expected = [&](const Vector3d& x) -> Vector3d {
    return moved.position + 1.2 * turn * (x - p.position);
  };
  for (int v = 0; v < static_cast<int>(model().mean.size()); v += 101)
    ASSERT_LT((after.vertex(v) - expected(before.vertex(v))).norm(), 1e-6) << v;
  for (int b = 0; b < static_cast<int>(model().bones.size()); ++b)
    ASSERT_LT((after.joint(b) - expected(before.joint(b))).norm(), 1e-12) << b;
}

TEST(PosedModel, BonesKeepTheirLengthsInEveryPose) {
  for (const std::uint32_t seed : {1, 2, 3, 4}) {
    Parameters p = random_woman(seed);
    p.log_scale = 0;
    Parameters rest = p;
    rest.turns.assign(rest.turns.size(), Vector3d::Zero());
    const PosedModel turned(model(), p), straight(model(), rest);
    for (std::size_t b = 1; b < model().bones.size(); ++b) {
      const int bone = static_cast<int>(b), parent = model().bones[b].parent;
      EXPECT_NEAR((turned.joint(bone) - turned.joint(parent)).norm(),
                  (straight.joint(bone) - straight.joint(parent)).norm(), 1e-9)
          << "seed " << seed << ", " << model().bones[b].name;
    }
  }
}

TEST(PosedModel, EveryShapeAtRestHasOneStature) {
  for (const std::uint32_t seed : {1, 2, 3, 4}) {
    Parameters p(model());
    p.shape = random_woman(seed).shape;
    const auto box = geometry::bounding_box(PosedModel(model(), p).vertices());
    EXPECT_NEAR(box[1].z() - box[0].z(), model().stature, 0.015)
        << "seed " << seed;  // components of 8 bits; principal ones alone
  }
}

}  // namespace
}  // namespace tensegric_fit::body_model
