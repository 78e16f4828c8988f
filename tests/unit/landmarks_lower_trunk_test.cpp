// Buttocks and hip on a person of simple shapes.
#include <gtest/gtest.h>

#include "landmarks/find_landmarks.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

TEST(LowerTrunk, ARollOfTheBackThatStandsOutFurtherIsNotTheSeat) {
  // Buttocks reach back to -0.14 at a height of 0.90; the roll to -0.17 at 1.06.
  const auto with_roll = [](const Vector3d& p) {
    const double roll = test::ellipsoid(p, {-0.08, 0, 1.06}, {0.09, 0.14, 0.06});
    return test::melt(test::person(p, {}), roll);
  };
  const geometry::BodyMeasures measures = landmarks::find_landmarks(
      test::surface_of(with_roll, {-0.2, -0.5, -0.02}, {0.26, 0.5, 1.74}, 0.012), {}, {});
  EXPECT_NEAR(measures.height("hip"), 0.90, 0.010);  // a cell of the grid is 12 mm
  EXPECT_NEAR(measures.landmark("buttock_L").x(), -0.14, 0.010);
}

}  // namespace
}  // namespace tensegric_fit
