// Normal pressure of a band on shapes whose curvature is known.
#include "tensegric/band_pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tensegric_fit::tensegric {
namespace {

constexpr int kNodes = 41;
constexpr double kRadius = 0.1, kWidth = 0.03, kPull = 2;  // m, m, N

// Half a circle of skin, its bone `below` metres inside it.
Model on_a_cylinder(double below) {
  Model model;
  for (int i = 0; i < kNodes; ++i) {
    const double angle = M_PI * i / (kNodes - 1);
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
    model.control.outer.push_back(kRadius * out);
    model.control.inner.push_back((kRadius - below) * out);
  }
  return model;
}

Band over_all(double width) {
  Band band;
  band.width = width;
  Thread thread{1, {}, {}, {}};
  for (int i = 0; i < kNodes; ++i) {
    thread.points.push_back({Eigen::Vector3d::Zero(), {{i, 1.0}}});
    thread.offsets.emplace_back(Eigen::Vector3d::Zero());
  }
  band.threads.push_back(thread);
  return band;
}

double pressure(double below, double width) {
  const Model model = on_a_cylinder(below);
  return largest_pressure(model, over_all(width), model.rest_positions(), kPull);
}

TEST(BandPressure, OnACylinderIsPullOverWidthAndRadius) {
  // The chords' curvature is off by half a part in (pi / 40)^2 / 4.
  EXPECT_NEAR(pressure(0.02, kWidth), kPull / kWidth / kRadius, 0.002 * kPull / kWidth / kRadius);
}

TEST(BandPressure, IsNoneWhereTheBandBendsAwayFromTheBodyOrHasNoWidth) {
  EXPECT_EQ(pressure(-0.02, kWidth), 0);
  EXPECT_EQ(pressure(0.02, 0), 0);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
