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
    const double angle = M_PI * i / (kNodes - 1);
    thread.points.push_back({kRadius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0), {{i, 1.0}}});
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

// On the inside of a sharp turn the points of a fibre come to lie within a millimetre of each other.
TEST(BandPressure, AKinkOfAMillimetreIsNoCurvature) {
  Model model = on_a_cylinder(0.02);
  Band band = over_all(kWidth);
  Thread& thread = band.threads[0];
  for (const auto& [up, along] : {std::pair{0.0, 0.001}, {0.00005, 0.001}, {0.0, 0.002}}) {
    const double angle = M_PI / 2 - along / kRadius;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0), at = (kRadius + up) * out;
    const std::size_t middle = kNodes / 2 + 1;
    thread.points.insert(thread.points.begin() + middle, {at, {{kNodes / 2, 1.0}}});
    thread.offsets.insert(thread.offsets.begin() + middle, at - model.control.outer[kNodes / 2]);
  }
  const double even = kPull / kWidth / kRadius;
  EXPECT_NEAR(largest_pressure(model, band, model.rest_positions(), kPull), even, 0.3 * even);
}

TEST(BandPressure, IsNoneWhereTheBandBendsAwayFromTheBodyOrHasNoWidth) {
  EXPECT_EQ(pressure(-0.02, kWidth), 0);
  EXPECT_EQ(pressure(0.02, 0), 0);
}

// Threads round a cylinder, `gap` apart: the pull of each is spread over the skin half way to its neighbours.
TEST(BandPressure, OfACupIsThatOfThePullWhereItsThreadsLie) {
  constexpr int kThreads = 7;
  const auto pressure = [&](double gap, double width) {
    Model model;
    Band band;
    band.width = width;
    band.cup = true;
    for (int t = 0; t < kThreads; ++t) {
      Thread thread{t == 0 || t == kThreads - 1 ? 1 / 12.0 : 1 / 6.0, {}, {}, {}};
      for (int i = 0; i < kNodes; ++i) {
        const double angle = M_PI * i / (kNodes - 1);
        const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0), along(0, 0, gap * t);
        thread.points.push_back(
            {kRadius * out + along, {{static_cast<int>(model.control.outer.size()), 1.0}}});
        thread.offsets.emplace_back(Eigen::Vector3d::Zero());
        model.control.outer.push_back(kRadius * out + along);
        model.control.inner.push_back(0.8 * kRadius * out + along);
      }
      band.threads.push_back(thread);
    }
    return largest_pressure(model, band, model.rest_positions(), kPull);
  };
  for (const double gap : {0.005, 0.015}) {
    const double wanted = kPull / (6 * gap) / kRadius;
    // The chords' curvature is off by half a part in (pi / 40)^2 / 4.
    EXPECT_NEAR(pressure(gap, 0.03), wanted, 0.002 * wanted);
    EXPECT_NEAR(pressure(gap, 0.01), wanted, 0.002 * wanted) << "whatever its width where it begins";
  }
}

}  // namespace
}  // namespace tensegric_fit::tensegric
