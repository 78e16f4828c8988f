// Finders of the waist, the sides, the crotch, the buttocks and their folds on surfaces whose answer is known
// in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "implicit_surface.hpp"
#include "landmarks/finders.hpp"
#include "landmarks_skin.hpp"

namespace tensegric_fit::landmarks {
namespace {

using test::capsule;

constexpr double kLeast = 1.083;  // m, height of a trunk's least girth

/// The trunk slims to `kLeast` like a hyperboloid, with elliptic sections.
const Surface& slim_trunk() {
  static const Surface surface = skin(test::surface_of(
      [](const Vector3d& p) {
        const double waist = std::sqrt(1 + std::pow((p.z() - kLeast) / 0.15, 2));
        const double side = 0.10 * (std::hypot(p.x() / 0.10, p.y() / 0.13) - waist);
        return std::max(side, std::abs(p.z() - 1.05) - 0.25);
      },
      {-0.25, -0.3, 0.78}, {0.25, 0.3, 1.32}, 0.0083));
  return surface;
}

TEST(WaistFinder, AHyperboloidsLeastGirth) {
  const Trunk trunk(slim_trunk());
  for (const double low : {0.90, 0.95, 1.02}) {
    const auto waist = find_waist(trunk, low, 1.20);
    ASSERT_TRUE(waist) << low;
    EXPECT_NEAR(*waist, kLeast, 0.001);  // less than half of a level
  }
}

TEST(WaistFinder, ATrunkThatOnlyWidensHasNoWaist) {
  const Trunk trunk(slim_trunk());
  EXPECT_FALSE(find_waist(trunk, kLeast + 0.02, 1.25));
  EXPECT_FALSE(find_waist(trunk, 0.85, kLeast - 0.02));
  EXPECT_FALSE(find_waist(trunk, 2, 2.1));
}

TEST(SideFinder, AnEllipsesEnds) {
  const Trunk trunk(slim_trunk());
  for (const Side side : kSides) {
    const auto end = find_side(trunk, side, kLeast);
    ASSERT_TRUE(end);
    EXPECT_NEAR(end->y(), kSign[side] * 0.13, 0.001);
    EXPECT_NEAR(end->x(), 0, 0.001);  // skin as far as 12 mm before and behind is within 3 mm of the farthest
    for (int i = 1; i < 10; ++i) {    // no vertex that comes and goes with the level moves it
      const auto above = find_side(trunk, side, kLeast + 0.0004 * i);
      ASSERT_TRUE(above);
      EXPECT_NEAR(above->x(), end->x(), 0.0005) << i;
    }
    EXPECT_FALSE(find_side(trunk, side, 2));
  }
}

/// A pelvis that is a level tube from side to side, on two legs clear of the midline.
const Surface& on_two_legs() {
  static const Surface surface = skin(test::surface_of(
      [](const Vector3d& p) {
        double d = capsule(p, {0, -0.08, 0.90}, {0, 0.08, 0.90}, 0.10, 0.10);
        for (const double side : {1.0, -1.0})
          d = std::min(d, capsule(p, {0, side * 0.085, 0.2}, {0, side * 0.085, 0.85}, 0.06, 0.07));
        return d;
      },
      {-0.13, -0.2, 0.12}, {0.13, 0.2, 1.02}, 0.0071));
  return surface;
}

TEST(CrotchFinder, TheLowestPlaceBetweenTwoLegs) {
  for (const Vector3d& off :
       {Vector3d(0, 0, 0), Vector3d(0.02, 0.004, 0.015), Vector3d(-0.02, -0.004, -0.015)}) {
    const auto crotch = find_crotch(on_two_legs(), Vector3d(0, 0, 0.80) + off);
    ASSERT_TRUE(crotch);
    EXPECT_NEAR(crotch->z(), 0.80, 0.0005);  // a chord of 10 mm in a circle of 100 mm
    EXPECT_NEAR(crotch->x(), 0, 0.010);      // half a millimetre of height
    EXPECT_NEAR(crotch->y(), off.y(), 1e-9);
  }
  EXPECT_FALSE(find_crotch(on_two_legs(), {0, 0, 0.5}));
}

TEST(ButtockFinder, AnEllipsoidsRear) {
  const Vector3d middle(-0.05, 0.07, 0.90), radii(0.09, 0.08, 0.10);
  const Surface surface =
      skin(test::surface_of([&](const Vector3d& p) { return test::ellipsoid(p, middle, radii); },
                            {-0.16, -0.03, 0.78}, {0.06, 0.17, 1.02}, 0.0041));
  const Trunk trunk(surface);
  for (const Vector3d& off : {Vector3d(0, 0, 0), Vector3d(0, 0.015, 0.02), Vector3d(0, -0.01, -0.02)}) {
    const auto buttock = find_buttock(trunk, middle - Vector3d(0.09, 0, 0) + off);
    ASSERT_TRUE(buttock);
    EXPECT_NEAR(buttock->z(), middle.z(), 0.002);  // 0.02 mm of depth
    EXPECT_NEAR(buttock->x(), middle.x() - 0.09,
                0.002);  // an ellipse is flatter than the parabola beside its apex
    EXPECT_NEAR(buttock->y(), middle.y(), 0.005);
  }
}

// A hand that rests beside it is the arm's skin, not the seat's.
TEST(ButtockFinder, SkinOfAnArmTakesNoPart) {
  const Vector3d middle(-0.05, 0.07, 0.90), radii(0.09, 0.08, 0.10);
  const auto seat = [&](const Vector3d& p) { return test::ellipsoid(p, middle, radii); };
  const auto hand = [&](const Vector3d& p) {
    return capsule(p, middle + Vector3d(-0.09, 0.030, 0.03), middle + Vector3d(-0.09, 0.030, -0.03), 0.012,
                   0.012);
  };
  Surface touched = skin(test::surface_of([&](const Vector3d& p) { return std::min(seat(p), hand(p)); },
                                          {-0.18, -0.03, 0.78}, {0.06, 0.17, 1.02}, 0.0041));
  std::size_t of_hand = 0;
  for (std::size_t v = 0; v < touched.mesh.vertices.size(); ++v)
    if (hand(touched.mesh.vertices[v]) < 0.003) touched.arm[v] = 0.6, ++of_hand;
  ASSERT_GT(of_hand, 50u);
  const auto buttock = find_buttock(Trunk(touched), middle + Vector3d(-0.09, -0.012, 0.015));
  ASSERT_TRUE(buttock);
  EXPECT_NEAR(buttock->y(), middle.y(), 0.005);
}

TEST(ButtockFinder, AFlatBackHasNoApex) {
  const Surface post = skin(test::surface_of(
      [](const Vector3d& p) { return std::max(std::hypot(p.x(), p.y()) - 0.1, std::abs(p.z()) - 0.2); },
      {-0.11, -0.11, -0.21}, {0.11, 0.11, 0.21}, 0.0071));
  EXPECT_FALSE(find_buttock(Trunk(post), {-0.1, 0, 0}));
}

/// A round seat over a straight thigh, whose backs are in line.
TEST(GlutealFoldFinder, TheCreaseBetweenSeatAndThigh) {
  const double radius = 0.09, thigh = 0.07;
  const Vector3d seat(-0.02, 0.08, 0.90);
  const Surface surface = skin(test::surface_of(
      [&](const Vector3d& p) {
        return std::min((p - seat).norm() - radius,
                        capsule(p, {-0.01, 0.08, 0.55}, {-0.01, 0.08, 0.85}, thigh, thigh));
      },
      {-0.13, -0.03, 0.46}, {0.09, 0.19, 1.01}, 0.0041));
  const Trunk trunk(surface);
  const Vector3d rear = seat - Vector3d(radius, 0, 0);
  // The ball meets the thigh's back, x = -0.08, 60 mm behind its middle.
  const double crease = seat.z() - std::sqrt(radius * radius - 0.06 * 0.06);
  const auto fold = find_gluteal_fold(trunk, rear, 0.22, 0.003);
  ASSERT_TRUE(fold);
  EXPECT_NEAR(fold->z(), crease, 0.004);  // a cell; the profile is smoothed over as much
  EXPECT_NEAR(fold->x(), -0.08, 0.003);
  EXPECT_FALSE(find_gluteal_fold(trunk, rear, 0.22, 0.10));  // not as deep
  EXPECT_FALSE(find_gluteal_fold(trunk, rear, 2, 0.003));    // nothing so far down
}

/// A plane that faces backwards and up: so far down as is asked for takes 2.4 times the way over skin that
/// rises by 25 degrees.
TEST(GlutealFoldFinder, IsLookedForOnTwiceTheWayDownAtMost) {
  for (const double rise : {25.0, 35.0}) {
    const Vector3d outward(-std::sin(rise * M_PI / 180), 0, std::cos(rise * M_PI / 180));
    const Surface slope = skin(test::surface_of(
        [&](const Vector3d& p) { return std::max(outward.dot(p), p.cwiseAbs().maxCoeff() - 0.2); },
        {-0.21, -0.21, -0.21}, {0.21, 0.21, 0.21}, 0.0071));
    const auto there =
        find_gluteal_fold(Trunk(slope), Vector3d(0.1, 0, 0.1 * std::tan(rise * M_PI / 180)), 0.05, -0.01);
    EXPECT_EQ(there.has_value(), rise > 30) << rise;
  }
}

}  // namespace
}  // namespace tensegric_fit::landmarks
