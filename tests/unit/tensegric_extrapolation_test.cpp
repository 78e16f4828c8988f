/// Anderson's extrapolation of fixed-point iterations.
#include "tensegric/extrapolation.hpp"

#include <gtest/gtest.h>

namespace tensegric_fit::tensegric {
namespace {

/// x -> A x + b, which shrinks slowly to its fixed point.
struct Linear {
  Eigen::Matrix3d a{{0.99, 0.02, 0}, {0, 0.95, -0.03}, {0.01, 0, -0.9}};
  Eigen::Vector3d b{1, -2, 0.5};
  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const { return a * x + b; }
  Eigen::Vector3d fixed() const { return (Eigen::Matrix3d::Identity() - a).inverse() * b; }
};

TEST(Extrapolation, IsThereAfterOneStepMoreThanUnknowns) {
  const Linear iterate;
  Extrapolation extrapolation(3, 3);
  Eigen::VectorXd x = Eigen::Vector3d(5, 1, -1);
  EXPECT_EQ(extrapolation.next(x, iterate(x)), iterate(x));  // nothing seen yet
  x = iterate(x);
  for (int step = 0; step < 3; ++step) x = extrapolation.next(x, iterate(x));
  EXPECT_LT((x - iterate.fixed()).norm(), 1e-9 * iterate.fixed().norm());
  EXPECT_GT((Eigen::Vector3d(5, 1, -1) - iterate.fixed()).norm(), 1);  // it was far away
}

TEST(Extrapolation, AfterARestartOnlyWhatCameSinceCounts) {
  const Linear iterate, other{-0.5 * Eigen::Matrix3d::Identity(), {3, 3, 3}};
  Extrapolation extrapolation(3, 3);
  Eigen::VectorXd x = Eigen::Vector3d::Ones();
  for (int step = 0; step < 4; ++step) x = extrapolation.next(x, other(x));
  extrapolation.restart();
  x = Eigen::Vector3d(5, 1, -1);
  EXPECT_EQ(extrapolation.next(x, iterate(x)), iterate(x));
  x = iterate(x);
  for (int step = 0; step < 3; ++step) x = extrapolation.next(x, iterate(x));
  EXPECT_LT((x - iterate.fixed()).norm(), 1e-9 * iterate.fixed().norm());
}

}  // namespace
}  // namespace tensegric_fit::tensegric
