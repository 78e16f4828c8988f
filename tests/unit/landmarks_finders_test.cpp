// Finders of folds, nipples, armpits, neck and limbs on surfaces whose answer is known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "implicit_surface.hpp"
#include "landmarks/finders.hpp"
#include "landmarks_skin.hpp"

namespace tensegric_fit::landmarks {
namespace {

using geometry::TriangleMesh;
using test::capsule;

constexpr double kDegree = M_PI / 180;

/// A chest that is the plane x = 0 with half a ball on it, joined by a fillet: an arc that is as hollow
/// everywhere.
struct Breast {
  static constexpr double kRadius = 0.060, kFillet = 0.012;  // m
  Vector3d middle{0, 0.08, 1.20};
  /// m, from the middle in the plane x = 0: to the middle of the fillet's circle, and to that of its arc.
  static double to_fillet() { return std::sqrt(kRadius * kRadius + 2 * kRadius * kFillet); }
  static double to_fold() {
    const double to_ball = to_fillet() / (kRadius + kFillet);  // its arc runs from (-1, 0) to there
    return to_fillet() - kFillet * std::sqrt((1 - std::sqrt(1 - to_ball * to_ball)) / 2);
  }

  double operator()(const Vector3d& p) const {
    const double x = p.x(), aside = std::hypot(p.y() - middle.y(), p.z() - middle.z());
    if (x < kFillet && aside < to_fillet() && aside * kFillet > x * to_fillet())
      return kFillet - std::hypot(x - kFillet, aside - to_fillet());
    const double block =
        std::max({x, -x - 0.05, std::abs(p.y() - 0.06) - 0.11, std::abs(p.z() - 1.18) - 0.16});
    return std::min(block, (p - middle).norm() - kRadius);
  }
  Vector3d tip(double medial) const {
    return {std::sqrt(kRadius * kRadius - medial * medial), middle.y() + medial, middle.z()};
  }
};

const Surface& breast() {
  static const Surface surface =
      skin(test::surface_of(Breast(), {-0.06, -0.06, 1.01}, {0.07, 0.18, 1.35}, 0.0031));
  return surface;
}

TEST(FoldFinder, AFilletsMiddleUnderTheBustPoint) {
  const Breast shape;
  const Trunk trunk(breast());
  const double height = shape.middle.z() - Breast::to_fold();
  for (const double off : {-0.012, 0.0, 0.012}) {  // of where it is expected
    const Fold fold =
        find_fold(trunk, shape.tip(0), kLeft, {Vector3d(0, shape.middle.y(), height + off)}, 0.025);
    ASSERT_FALSE(fold.places.empty());
    // Steps of 1 mm, and the smoothing of a profile rounds an arc of 12 mm by 0.7.
    EXPECT_NEAR(fold.places.front().z(), height, 0.002) << off;
    EXPECT_NEAR(fold.lowest.z(), height, 0.002) << off;
  }
}

TEST(FoldFinder, RunsRoundTheBreastAndIsLowestInItsMiddle) {
  const Breast shape;
  const Trunk trunk(breast());
  const double outside = 0.020,
               height = shape.middle.z() - std::sqrt(std::pow(Breast::to_fold(), 2) - outside * outside);
  const Fold fold =
      find_fold(trunk, shape.tip(outside), kLeft, {Vector3d(0, shape.middle.y() + outside, height)}, 0.025);
  ASSERT_GT(fold.places.size(), 16u);  // 40 mm inwards
  for (const Vector3d& place : fold.places) {
    const double round = std::hypot(place.y() - shape.middle.y(), place.z() - shape.middle.z());
    EXPECT_NEAR(round, Breast::to_fold(), 0.003) << place.transpose();  // profiles cut the fold askew
  }
  EXPECT_NEAR(fold.lowest.z(), shape.middle.z() - Breast::to_fold(), 0.002);
  EXPECT_NEAR(fold.lowest.y(), shape.middle.y(), 0.008);  // 0.5 mm of height
}

// A scar below the fold takes the places of four profiles in 23, 6 mm down: the arc through the others is
// what counts, and its lowest place goes by less than a fifth of that.
TEST(FoldFinder, AScarBelowTheFoldHardlyMovesItsLowestPlace) {
  const Breast shape;
  constexpr double kOutside = 0.020, kDown = 0.006;  // m
  const double height = shape.middle.z() - std::sqrt(std::pow(Breast::to_fold(), 2) - kOutside * kOutside);
  const auto fold_on = [&](const Surface& surface) {
    return find_fold(Trunk(surface), shape.tip(kOutside), kLeft,
                     {Vector3d(0, shape.middle.y() + kOutside, height)}, 0.025);
  };
  const Vector3d scar(0, shape.middle.y() + 0.008, shape.middle.z() - Breast::to_fold() - 0.007);
  const Surface scarred = skin(test::surface_of(
      [&](const Vector3d& p) {
        return std::max(shape(p), -capsule(p, scar, scar + Vector3d(0, 0.002, 0), 0.004, 0.004));
      },
      {-0.06, -0.06, 1.01}, {0.07, 0.18, 1.35}, 0.0031));
  const Fold plain = fold_on(breast()), with_scar = fold_on(scarred);
  ASSERT_EQ(with_scar.places.size(), plain.places.size());
  int taken = 0;
  for (std::size_t i = 0; i < plain.places.size(); ++i)
    taken += with_scar.places[i].z() < plain.places[i].z() - kDown + 0.001;
  EXPECT_GE(taken, 3);
  EXPECT_NEAR(with_scar.lowest.z(), plain.lowest.z(), kDown / 5);
}

TEST(FoldFinder, ABallHasNone) {
  const Surface ball = skin(test::surface_of([](const Vector3d& p) { return p.norm() - 0.12; },
                                             {-0.13, -0.13, -0.13}, {0.13, 0.13, 0.13}, 0.0047));
  const Trunk trunk(ball);
  EXPECT_TRUE(find_fold(trunk, {0.12, 0, 0}, kLeft, {Vector3d(0.08, 0, -0.08)}, 0.025).places.empty());
}

/// A ball with a nipple: a Gaussian bump 5 mm high.
struct NippledBall {
  static constexpr double kRadius = 0.080, kHeight = 0.005, kWidth = 0.007;  // m
  double height = kHeight;
  Vector3d way = Vector3d(0.9, 0.3, -0.1).normalized();
  double operator()(const Vector3d& p) const {
    const double off = kRadius * std::acos(std::min(1.0, p.normalized().dot(way)));
    return p.norm() - kRadius - height * std::exp(-0.5 * off * off / (kWidth * kWidth));
  }
  Surface surface(double noise, unsigned seed) const {
    TriangleMesh mesh = test::surface_of(*this, {0, -0.09, -0.09}, {0.09, 0.09, 0.09}, 0.0029);
    std::mt19937 random(seed);
    std::normal_distribution<double> off(0, noise);
    if (noise > 0)
      for (Vector3d& v : mesh.vertices) v += off(random) * v.normalized();
    return skin(std::move(mesh));
  }
};

constexpr double kDeviation = 0.010;  // m

TEST(NippleFinder, ABumpsTop) {
  const NippledBall ball;
  const Vector3d tip = (NippledBall::kRadius + NippledBall::kHeight) * ball.way;
  // Places tried are 1.2 mm apart; in noise the place that is expected counts, 12 to 14 mm away here.
  for (const auto& [noise, limit] : {std::pair(0.0, 0.0015), std::pair(0.0005, 0.004)}) {
    const Surface surface = ball.surface(noise, 1);
    for (const Vector3d& off : {Vector3d(0, 0.012, 0.006), Vector3d(0, -0.010, 0.010), Vector3d(0, 0, 0)}) {
      const Vector3d expected = NippledBall::kRadius * (tip + off).normalized();
      const auto found = find_nipple(surface, expected, kDeviation, expected.normalized());
      ASSERT_TRUE(found) << noise;
      EXPECT_LT((found->place - tip).norm(), limit) << noise << " " << off.transpose();
    }
  }
}

TEST(NippleFinder, TheLessClearABumpTheFurtherItMayBeMoved) {
  const auto shift_of = [](double height, double noise) {
    const NippledBall ball{height};
    const auto found =
        find_nipple(ball.surface(noise, 1), NippledBall::kRadius * ball.way, kDeviation, ball.way);
    EXPECT_TRUE(found) << height << " " << noise;
    return found ? found->shift : std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_LT(shift_of(0.005, 0), shift_of(0.003, 0));
  EXPECT_LT(shift_of(0.005, 0), shift_of(0.005, 0.0005));
  EXPECT_LT(shift_of(0.005, 0.0005), shift_of(0.003, 0.0005));
}

TEST(NippleFinder, NoiseIsNoNipple) {
  for (const unsigned seed : {1, 2, 3, 4, 5}) {
    const NippledBall bare{0};
    const Vector3d expected = NippledBall::kRadius * bare.way;
    EXPECT_FALSE(find_nipple(bare.surface(0.0005, seed), expected, kDeviation, bare.way)) << "seed " << seed;
  }
}

constexpr double kTrunkRadius = 0.12, kArmRadius = 0.04;  // m

double trunk_at(const Vector3d& p) {
  return std::max(std::hypot(p.x(), p.y()) - kTrunkRadius, std::abs(p.z() - 1.15) - 0.25);
}

Surface with_arm_named(Surface surface, const Vector3d& shoulder, const Vector3d& hand) {
  for (std::size_t v = 0; v < surface.arm.size(); ++v) {
    const Vector3d& p = surface.mesh.vertices[v];
    surface.arm[v] = capsule(p, shoulder, hand, kArmRadius, kArmRadius) < trunk_at(p) ? 1 : 0;
  }
  return surface;
}

/// A round trunk with an arm on its left from the shoulder to the hand.
Surface with_arm(const Vector3d& shoulder, const Vector3d& hand) {
  return with_arm_named(skin(test::surface_of(
                            [&](const Vector3d& p) {
                              return std::min(trunk_at(p),
                                              capsule(p, shoulder, hand, kArmRadius, kArmRadius));
                            },
                            {-0.13, -0.13, 0.79}, {0.13, std::max(hand.y() + 0.05, 0.2), 1.43}, 0.0041)),
                        shoulder, hand);
}

TEST(AxillaFinder, WhereALeaningArmComesClearOfTheTrunk) {
  const Vector3d shoulder(0, 0.10, 1.35), hand(0, 0.40, 0.88);
  const Vector3d way = (hand - shoulder).normalized();
  const double half_breadth = kArmRadius / -way.z(),  // of its level section
      height = shoulder.z() - (kTrunkRadius + half_breadth - shoulder.y()) * -way.z() / way.y();
  const auto axilla = find_axilla(with_arm(shoulder, hand), kLeft, 1.0, 1.4, 0);
  ASSERT_TRUE(axilla);
  // The wedge is one cell wide 6 mm under its end.
  EXPECT_NEAR(axilla->z(), height - 0.003, 0.0045);
  EXPECT_NEAR(axilla->y(), kTrunkRadius, 0.003);
  EXPECT_NEAR(axilla->x(), 0, 0.010);  // the wedge's end is round: 1 mm there
}

TEST(AxillaFinder, OfALevelArmTheCornerUnderIt) {
  const Surface surface = with_arm({0, 0.05, 1.30}, {0, 0.45, 1.30});
  const auto axilla = find_axilla(surface, kLeft, 1.0, 1.4, 45 * kDegree);
  ASSERT_TRUE(axilla);
  EXPECT_NEAR(axilla->z(), 1.30 - kArmRadius, 0.005);
  EXPECT_NEAR(axilla->y(), kTrunkRadius, 0.005);
}

// Flat sides that nearly touch all along: whichever two vertices are nearest, the middle is theirs.
TEST(AxillaFinder, OfSkinsThatNearlyTouchTheMiddle) {
  constexpr double kHalf = 0.05, kLean = 0.1;  // m before and behind; of the arm, sideways over down
  const auto box = [](const Vector3d& p, const Vector3d& half) { return (p.cwiseAbs() - half).maxCoeff(); };
  const auto trunk = [&](const Vector3d& p) { return box(p - Vector3d(0, 0, 1.15), {kHalf, 0.12, 0.25}); };
  const auto arm = [&](const Vector3d& p) {
    return box(p - Vector3d(0, 0.16 + kLean * (1.30 - p.z()), 1.15), {kHalf, 0.04, 0.2});
  };
  for (const double turn : {0.0, 0.004}) {  // rad, by which other vertices are nearest
    const Eigen::Matrix3d to = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).matrix();
    Surface surface =
        skin(test::surface_of([&](const Vector3d& p) { return std::min(trunk(to * p), arm(to * p)); },
                              {-0.07, -0.13, 0.89}, {0.07, 0.26, 1.41}, 0.0041));
    for (std::size_t v = 0; v < surface.arm.size(); ++v) {
      const Vector3d p = to * surface.mesh.vertices[v];
      surface.arm[v] = arm(p) < trunk(p) ? 1 : 0;
    }
    const auto axilla = find_axilla(surface, kLeft, 1.0, 1.4, 0);
    ASSERT_TRUE(axilla);
    EXPECT_NEAR((to * *axilla).x(), 0, turn > 0 ? 0.006 : 0.003) << turn;
  }
}

TEST(AxillaFinder, AHollowInsideTheTrunkIsNoArm) {
  const Vector3d shoulder(0, 0.10, 1.35), hand(0, 0.40, 0.88);
  // Where a scan does not see into the armpit, its wedge may go on inside the mesh, up to the shoulder.
  const Vector3d end = find_axilla(with_arm(shoulder, hand), kLeft, 1.0, 1.4, 0).value();
  const Surface hollow = with_arm_named(
      skin(test::surface_of(
          [&](const Vector3d& p) {
            const double body = std::min(trunk_at(p), capsule(p, shoulder, hand, kArmRadius, kArmRadius));
            return std::max(body, -capsule(p, end, end + Vector3d(0, -0.02, 0.06), 0.012, 0.012));
          },
          {-0.13, -0.13, 0.79}, {0.13, 0.45, 1.43}, 0.0041)),
      shoulder, hand);
  const auto axilla = find_axilla(hollow, kLeft, 1.0, 1.4, 0);
  ASSERT_TRUE(axilla);
  EXPECT_NEAR(axilla->z(), end.z(), 0.020);  // the hollow's mouth; its top is 70 mm up
}

// Hair over a shoulder, a bag: an outline beside the trunk that is none of the arm's.
TEST(AxillaFinder, WhatHangsBesideTheTrunkIsNoArm) {
  Surface surface = with_arm({0, 0.10, 1.35}, {0, 0.40, 0.88});
  std::fill(surface.arm.begin(), surface.arm.end(), 0);
  EXPECT_FALSE(find_axilla(surface, kLeft, 1.0, 1.4, 0));
}

TEST(AxillaFinder, WithoutAnArmThereIsNone) {
  const Surface surface = with_arm({0, 0.10, 1.35}, {0, 0.40, 0.88});
  EXPECT_FALSE(find_axilla(surface, kRight, 1.0, 1.4, 0));
}

TEST(NeckFinder, ATiltedHyperboloidsLeastGirth) {
  const Vector3d middle(0.01, 0, 1.45), along = Vector3d(std::sin(18 * kDegree), 0, std::cos(18 * kDegree));
  constexpr double kRadius = 0.055;
  const Surface neck = skin(test::surface_of(
      [&](const Vector3d& p) {
        const double up = along.dot(p - middle), aside = (p - middle - up * along).norm();
        return std::max(aside - std::hypot(kRadius, 0.7 * up), std::abs(p.z() - 1.45) - 0.09);
      },
      {-0.12, -0.12, 1.35}, {0.14, 0.12, 1.55}, 0.0041));
  for (const double below : {0.020, 0.035}) {
    const auto tape = find_neck(neck, middle - below * along, along);
    ASSERT_GT(tape.size(), 20u);
    EXPECT_NEAR(geometry::length_of(tape, true), 2 * M_PI * kRadius,
                0.0005);  // chords of 6 mm: a thousandth of it
    for (const Vector3d& p : tape) EXPECT_NEAR(along.dot(p - middle), 0, 1e-6);
  }
  EXPECT_TRUE(find_neck(neck, middle + along, along).empty());
}

TEST(NeckFinder, OfANeckThatNarrowsAllTheWayTheGirth40MmUp) {
  const auto radius = [](double up) { return 0.065 - 0.3 * up; };  // m; under the chin
  const Surface neck = skin(test::surface_of(
      [&](const Vector3d& p) {
        const double slope = std::sqrt(1 + 0.3 * 0.3);
        return std::max((std::hypot(p.x(), p.y()) - radius(p.z())) / slope, std::abs(p.z() - 0.03) - 0.06);
      },
      {-0.09, -0.09, -0.05}, {0.09, 0.09, 0.11}, 0.0041));
  const auto tape = find_neck(neck, Vector3d::Zero(), Vector3d::UnitZ());
  ASSERT_GT(tape.size(), 20u);
  for (const Vector3d& p : tape) EXPECT_NEAR(p.z(), 0.040, 1e-6);
  EXPECT_NEAR(geometry::length_of(tape, true), 2 * M_PI * radius(0.040), 0.0005);
}

TEST(SkinAbove, ABallsTop) {
  const Surface ball = skin(test::surface_of([](const Vector3d& p) { return p.norm() - 0.1; },
                                             {-0.11, -0.11, -0.11}, {0.11, 0.11, 0.11}, 0.0047));
  for (const Vector3d& under :
       {Vector3d(0, 0, 0.09), Vector3d(0.03, -0.02, 0.06), Vector3d(-0.05, 0.01, 0.07)}) {
    const auto skin = skin_above(ball, under);
    ASSERT_TRUE(skin);
    EXPECT_LT(
        (*skin - Vector3d(under.x(), under.y(), std::sqrt(0.01 - under.head<2>().squaredNorm()))).norm(),
        0.0002);
  }
  EXPECT_FALSE(skin_above(ball, {0.2, 0, 0.05}));
}

TEST(LimbTape, IsSquareToALeaningTube) {
  const Vector3d from(0, 0.15, 1.3), to(0.05, 0.40, 0.9), along = (to - from).normalized(),
                                                          middle = (from + to) / 2;
  const double radius = 0.042;
  const Surface surface = skin(test::surface_of(
      [&](const Vector3d& p) {
        const double arm = capsule(p, from, to, radius, radius),
                     other =
                         capsule(p, from + Vector3d(0, 0.25, 0), to + Vector3d(0, 0.25, 0), radius, radius);
        return std::min(arm, other);
      },
      {-0.06, 0.09, 0.84}, {0.12, 0.71, 1.36}, 0.0047));
  const auto all = [](const Eigen::Vector3i&) { return true; };
  const auto tape = round_limb(surface, middle, along, 0.07, all);
  ASSERT_GT(tape.size(), 10u);
  EXPECT_NEAR(geometry::length_of(tape, true), 2 * M_PI * radius,
              0.0008);  // chords of up to 8 mm: 0.3 % of it
  EXPECT_TRUE(round_limb(surface, middle, along, 0.07, [](const Eigen::Vector3i&) { return false; }).empty());
  EXPECT_TRUE(round_limb(surface, middle + Vector3d(0.3, 0, 0), along, 0.07, all).empty());
}

TEST(UnseenShare, WhereAMeshIsCoarseTheNearestVertexCounts) {
  TriangleMesh mesh;
  mesh.vertices = {Vector3d(0, 0, 0), Vector3d(0.06, 0, 0), Vector3d(0, 0.06, 0)};
  mesh.triangles = {Eigen::Vector3i(0, 1, 2)};
  Surface coarse = skin(mesh);
  EXPECT_EQ(unseen_share(coarse, Vector3d(0.025, 0, 0), 0.015), 0);
  coarse.unseen = {0, 1, 1};
  EXPECT_EQ(unseen_share(coarse, Vector3d(0.025, 0, 0), 0.015), 0);
  EXPECT_EQ(unseen_share(coarse, Vector3d(0.035, 0, 0), 0.015), 1);
  EXPECT_NEAR(unseen_share(coarse, Vector3d(0.02, 0.02, 0), 0.1), 2.0 / 3, 1e-12);
}

TEST(Profile, AnArcsCurvature) {
  for (const double radius : {0.05, 0.2}) {
    const Surface tube = skin(
        test::surface_of([&](const Vector3d& p) { return std::hypot(p.x(), p.z()) - radius; },
                         {-1.1 * radius, -0.03, -1.1 * radius}, {1.1 * radius, 0.03, 1.1 * radius}, 0.0051));
    const geometry::TriangleMesh& mesh = tube.mesh;
    ASSERT_FALSE(mesh.triangles.empty());
    const Trunk trunk(tube);
    const Profile profile = profile_down(trunk, {radius, 0, 0}, 0.06);
    ASSERT_GT(profile.points.size(), 50u);
    double sum = 0;
    for (std::size_t i = 15; i < 45; ++i) sum += profile.curvature[i] / 30;
    EXPECT_NEAR(sum, -1 / radius, 0.05 / radius);
    EXPECT_LT(profile.points.back().z(), -0.04);
    EXPECT_TRUE(profile_down(trunk, {radius + 0.2, 0, 0}, 0.06).points.empty());
  }
}

}  // namespace
}  // namespace tensegric_fit::landmarks
