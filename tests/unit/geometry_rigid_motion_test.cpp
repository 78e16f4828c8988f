#include "geometry/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tensegric_fit::geometry {
namespace {

TEST(ShortestTurn, TurnsOntoTheOtherDirectionByTheAngleBetween) {
  const Eigen::Vector3d from(0.3, -2, 0.7), to(-1, 0.2, 4);
  const Eigen::AngleAxisd turn(shortest_turn(from, to));
  EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-14);
  EXPECT_NEAR(turn.angle(), std::acos(from.normalized().dot(to.normalized())), 1e-14);
  EXPECT_NEAR(turn.axis().dot(from), 0, 1e-14);
}

TEST(ShortestTurn, OfTheSameAndOfOppositeDirections) {
  const Eigen::Vector3d one(0.6, 0, -0.8);
  EXPECT_LT((shortest_turn(one, 2 * one) * one - one).norm(), 1e-14);
  EXPECT_LT((shortest_turn(one, -one) * one + one).norm(), 1e-14);
}

TEST(MotionAbout, TurnsAboutTheCentreThenShifts) {
  const Eigen::Vector3d centre(1, 2, 3), shift(0.1, 0, -0.2);
  const Eigen::Isometry3d motion = motion_about(centre, Eigen::Vector3d(0, 0, M_PI / 2), shift);
  EXPECT_LT((motion * centre - (centre + shift)).norm(), 1e-14);
  EXPECT_LT(
      (motion * (centre + Eigen::Vector3d::UnitX()) - (centre + shift + Eigen::Vector3d::UnitY())).norm(),
      1e-14);
}

/// The row's product with a small motion is what the motion moves the point by, to second order.
TEST(AlongNormal, IsTheDerivativeOfTheMotion) {
  const Eigen::Vector3d point(0.4, -0.1, 1.2), centre(0, 0.1, 1),
      normal = Eigen::Vector3d(1, 2, -1).normalized();
  SmallMotion motion;
  motion << 1e-5, -2e-5, 3e-5, 2e-5, 1e-5, -4e-5;
  const double moved = normal.dot(motion_about(centre, motion) * point - point);
  EXPECT_GT(std::abs(moved), 1e-5);
  EXPECT_NEAR(along_normal(point, centre, normal).dot(motion), moved, 1e-9);
}

}  // namespace
}  // namespace tensegric_fit::geometry
