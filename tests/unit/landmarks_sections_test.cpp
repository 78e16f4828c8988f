// The pieces that the landmarks are found with, on shapes whose answer is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "landmarks/arm_cut.hpp"
#include "landmarks/hanging_breast.hpp"
#include "landmarks/junction.hpp"
#include "landmarks/outline.hpp"
#include "landmarks/sliced_mesh.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::vector<Eigen::Vector3d> ellipse(double rx, double ry, double cy = 0, int count = 360) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2 * kPi * (i + 0.5) / count;
    points.emplace_back(rx * std::cos(a), cy + ry * std::sin(a), 1.0);
  }
  return points;
}

double ellipse_perimeter(double a, double b) {  // Ramanujan; good to 1e-6 here
  const double h = std::pow((a - b) / (a + b), 2);
  return kPi * (a + b) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h)));
}

TEST(Outline, AreaCentroidMomentAndTapeOfAnEllipse) {
  const landmarks::Outline outline = landmarks::outline_of(ellipse(0.10, 0.15, 0.02));
  EXPECT_NEAR(outline.area, kPi * 0.10 * 0.15, 1e-5);  // a 360-gon lacks 5e-5 of it
  EXPECT_NEAR((outline.centroid - Eigen::Vector2d(0, 0.02)).norm(), 0, 1e-12);
  const Eigen::Matrix2d moment = landmarks::second_moment(outline, outline.centroid);
  EXPECT_NEAR(moment(0, 0) / outline.area, 0.10 * 0.10 / 4, 1e-6);
  EXPECT_NEAR(moment(1, 1) / outline.area, 0.15 * 0.15 / 4, 1e-6);
  EXPECT_NEAR(landmarks::tape_length({outline}), ellipse_perimeter(0.10, 0.15), 1e-4);
  EXPECT_TRUE(landmarks::contains(outline, {0.05, 0.02}));
  EXPECT_FALSE(landmarks::contains(outline, {0.099, 0.10}));
}

TEST(SlicedMesh, EverySectionOfASphereIsItsCircle) {
  const geometry::TriangleMesh mesh =
      test::surface_of([](const Eigen::Vector3d& p) { return p.norm() - 0.3; }, {-0.35, -0.35, -0.35},
                       {0.35, 0.35, 0.35}, 0.0137);
  const landmarks::SlicedMesh sliced(mesh);
  for (double z = -0.28; z < 0.28; z += 0.0173) {
    const std::vector<landmarks::Outline> outlines = sliced.outlines_at(z);
    ASSERT_EQ(outlines.size(), 1u) << "z " << z;
    // Chords of 14 mm lie up to 0.1 mm inside; 2 pi times as much in the girth.
    EXPECT_NEAR(landmarks::tape_length(outlines), 2 * kPi * std::sqrt(0.09 - z * z), 2e-3) << "z " << z;
  }
  EXPECT_TRUE(sliced.outlines_at(0.4).empty());
}

// A post of elliptic section with an arm on each side that is joined to it by skin 40 mm broad; z from 0 to
// 0.4, and above 0.2 the arm is one with the post over 90 mm.
double post_with_arms(const Eigen::Vector3d& p) {
  const double post = test::ellipsoid({p.x(), p.y(), 0}, {0, 0, 0}, {0.10, 0.14, 1});
  double d = std::max({post * 0.1, -p.z(), p.z() - 0.4});
  const double y = std::abs(p.y());
  const double arm = std::hypot(p.x(), y - 0.20) - 0.045;
  const double skin = std::max({std::abs(p.x()) - (p.z() < 0.2 ? 0.02 : 0.045), y - 0.20, 0.10 - y});
  return std::min(d, std::max({std::min(arm, skin), 0.05 - p.z(), p.z() - 0.35}));
}

TEST(ArmCut, FusedArmsComeOffAndTheTapeIsThePostsOwn) {
  const landmarks::SlicedMesh sliced(
      test::surface_of(post_with_arms, {-0.15, -0.3, -0.02}, {0.15, 0.3, 0.42}, 0.0067));
  const std::vector<landmarks::Outline> outlines = sliced.outlines_at(0.12);
  ASSERT_EQ(outlines.size(), 1u);
  const landmarks::Outline post = landmarks::without_arms(outlines.front(), 1.65);
  // What is left of the 40 mm bridge may stand out a few millimetres on each side.
  EXPECT_NEAR(landmarks::tape_length({post}), ellipse_perimeter(0.10, 0.14), 0.012);
  EXPECT_GT(landmarks::tape_length(outlines), ellipse_perimeter(0.10, 0.14) + 0.1);
}

TEST(ArmCut, AnOutlineWithoutArmsStaysAsItIs) {
  const landmarks::Outline outline = landmarks::outline_of(ellipse(0.10, 0.15));
  EXPECT_EQ(landmarks::without_arms(outline, 1.65).points, outline.points);
}

// The same post with a breast 80 mm broad before its left side, joined to it by skin 20 mm broad.
double post_with_breast(const Eigen::Vector3d& p) {
  const double post = test::ellipsoid({p.x(), p.y(), 0}, {0, 0, 0}, {0.10, 0.14, 1}) * 0.1;
  const double breast = std::hypot(p.x() - 0.14, p.y() - 0.06) - 0.04;
  const double skin = std::max({std::abs(p.y() - 0.06) - 0.010, p.x() - 0.14, 0.05 - p.x()});
  return std::max({std::min({post, breast, skin}), -p.z(), p.z() - 0.2});
}

TEST(HangingBreast, ComesOffAndTheTapeIsThePostsOwn) {
  const landmarks::SlicedMesh sliced(
      test::surface_of(post_with_breast, {-0.15, -0.2, -0.02}, {0.22, 0.2, 0.22}, 0.005));
  const std::vector<landmarks::Outline> outlines = sliced.outlines_at(0.1);
  ASSERT_EQ(outlines.size(), 1u);
  const std::array<Eigen::Vector3d, 2> tips{Eigen::Vector3d(0.18, 0.06, 0.15),
                                            Eigen::Vector3d(0.10, -0.06, 0.15)};
  const landmarks::Outline post = landmarks::without_hanging_breasts(outlines.front(), tips, 1.65);
  // What is left of the 20 mm bridge stands out by up to 5 mm on a grid of 5 mm.
  EXPECT_NEAR(landmarks::tape_length({post}), ellipse_perimeter(0.10, 0.14), 0.010);
  EXPECT_GT(landmarks::tape_length(outlines), ellipse_perimeter(0.10, 0.14) + 0.05);
}

TEST(HangingBreast, ASectionWithoutALobeStaysAsItIs) {
  const landmarks::Outline outline = landmarks::outline_of(ellipse(0.10, 0.15));
  const std::array<Eigen::Vector3d, 2> tips{Eigen::Vector3d(0.10, 0.08, 1), Eigen::Vector3d(0.10, -0.08, 1)};
  EXPECT_EQ(landmarks::without_hanging_breasts(outline, tips, 1.65).points, outline.points);
}

TEST(Junction, IsWhereTheLimbIsJoinedOverItsDepthNotWhereSkinFillsTheGap) {
  const landmarks::SlicedMesh sliced(
      test::surface_of(post_with_arms, {-0.15, -0.3, -0.02}, {0.15, 0.3, 0.42}, 0.0067));
  const landmarks::Bridge bridge = landmarks::narrowest_bridge(sliced.outlines_at(0.12), 0.145, 0.155);
  EXPECT_NEAR(bridge.length, 0.04, 0.004);  // the grid of 7 mm rounds the edges
  EXPECT_NEAR(bridge.front + bridge.back, 0, 0.002);
  const landmarks::Junction junction = landmarks::find_junction(sliced, {0.03, 0.30, 0.145, 0.155, 0.09});
  EXPECT_NEAR(junction.height, 0.2, 0.007);  // the grid's spacing
}

// Two posts 0.10 m deep; the bridge between them has no length at 0.15, half at 0.20 and all at 0.25, but
// skin 30 mm broad fills the gap under it.
double posts_with_filled_gap(const Eigen::Vector3d& p) {
  const double share = std::clamp((p.z() - 0.15) * 10, 0.3, 1.0);
  const double post = std::max(std::abs(p.x()) - 0.05, std::abs(std::abs(p.y()) - 0.08) - 0.05);
  const double skin = std::max(std::abs(p.x()) - 0.05 * share, std::abs(p.y()) - 0.08);
  return std::max({std::min(post, skin), -p.z(), p.z() - 0.4});
}

TEST(Junction, ALimbIsOneWithTheTrunkWhateverFillsTheGapBelow) {
  const landmarks::SlicedMesh sliced(
      test::surface_of(posts_with_filled_gap, {-0.1, -0.2, -0.02}, {0.1, 0.2, 0.42}, 0.0067));
  const landmarks::Root root = landmarks::find_root(sliced, {0.05, 0.30, -0.01, 0.01, 0}, 0.04);
  ASSERT_TRUE(root.found);
  EXPECT_NEAR(root.height, 0.24, 0.003);  // half the grid's spacing
  EXPECT_FALSE(
      landmarks::find_root(sliced, {0.26, 0.30, -0.01, 0.01, 0}, 0.04).found);  // nothing grows there
}

}  // namespace
}  // namespace tensegric_fit
