#include "geometry/parabola.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tensegric_fit::geometry {
namespace {

TEST(Parabola, IsFoundThroughItsOwnPlaces) {
  Parabola parabola;
  for (int i = -7; i <= 5; ++i) parabola.add(i / 7.0, 0.3 - 2 * i / 7.0 + 5 * i * i / 49.0);
  EXPECT_EQ(parabola.count(), 13);
  EXPECT_LT((parabola.coefficients() - Eigen::Vector3d(0.3, -2, 5)).norm(), 1e-13);
}

/// Residuals of least squares are perpendicular to 1, x and x^2.
TEST(Parabola, OfLeastSquares) {
  const auto cubic = [](double x) { return x * x * x + std::abs(x); };
  Parabola parabola;
  for (int i = -10; i <= 12; ++i) parabola.add(i / 12.0, cubic(i / 12.0));
  const Eigen::Vector3d c = parabola.coefficients();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  double largest = 0;
  for (int i = -10; i <= 12; ++i) {
    const Eigen::Vector3d terms(1, i / 12.0, i / 12.0 * i / 12.0);
    const double residual = cubic(i / 12.0) - c.dot(terms);
    products += residual * terms;
    largest = std::max(largest, std::abs(residual));
  }
  EXPECT_GT(largest, 0.01);  // it is no parabola
  EXPECT_LT(products.norm(), 1e-13);
}

}  // namespace
}  // namespace tensegric_fit::geometry
