/// What becomes of measures where the skin moves: a trunk with two arms, all of them cylinders.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/moved_skin.hpp"
#include "geometry/section.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kTrunk = 0.15, kArm = 0.05, kGap = 0.02;  // m
constexpr int kAround = 120, kLevels = 41;

void add_tube(TriangleMesh& mesh, const Vector3d& foot, double radius, double slope = 0) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int level = 0; level < kLevels; ++level) {
    const double z = 0.01 * level;  // no level lies on the plane of the tape, 0.205 above the foot
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * kPi * i / kAround, r = radius + slope * (0.205 - z);
      mesh.vertices.push_back(foot + Vector3d(r * std::cos(angle), r * std::sin(angle), z));
      if (level == 0) continue;
      const int here = first + level * kAround + i, next = first + level * kAround + (i + 1) % kAround;
      mesh.triangles.emplace_back(here - kAround, next - kAround, next);
      mesh.triangles.emplace_back(here - kAround, next, here);
    }
  }
}

class MovedSkinTest : public testing::Test {
 protected:
  void SetUp() override {
    add_tube(mesh_, {0, 0, 1}, kTrunk);
    add_tube(mesh_, {0, kTrunk + kGap + kArm, 1}, kArm);
    add_tube(mesh_, {0, -kTrunk - kGap - kArm, 1}, kArm);
    std::vector<Vector3d> loop;
    for (int i = 0; i < kAround; ++i)
      loop.emplace_back(kTrunk * std::cos(2 * kPi * i / kAround), kTrunk * std::sin(2 * kPi * i / kAround),
                        1.205);
    measures_.girths = {{"bust", 2 * kPi * kTrunk, 0.9, ""}, {"neck", 0.35, 0.9, ""}};
    measures_.loops = {{"bust", loop}};
    measures_.landmarks = {{"bust_point_L", {kTrunk, 0, 1.2}, 0.9, ""},
                           {"bust_point_R", {-kTrunk, 0, 1.2}, 0.9, ""}};
    measures_.heights = {{"bust", 1.2, 0.9, ""}, {"stature", 1.4, 0.9, ""}, {"waist", 1.1, 0.9, ""}};
  }

  /// Moves the trunk alone.
  template <typename Move>
  std::vector<Vector3d> moved(const Move& move) const {
    std::vector<Vector3d> after = mesh_.vertices;
    for (int v = 0; v < kAround * kLevels; ++v) after[v] = move(after[v]);
    return after;
  }

  double girth(const std::vector<Vector3d>& after) const {
    return girths_after(measures_, {mesh_, after}).at(0).after.value();
  }

  TriangleMesh mesh_;
  BodyMeasures measures_;
};

TEST(ChangedMeasure, ChangesByWhatIsReadOffTheTwo) {
  ChangedMeasure girth;
  girth.before.metres = 0.91244;  // shown as 91.2
  girth.after = 0.86860;          // shown as 86.9; -4.38 by itself
  EXPECT_NEAR(girth.change(), -0.043, 1e-12);
}

TEST_F(MovedSkinTest, SkinThatStaysChangesNothing) {
  const std::vector<Vector3d> after = mesh_.vertices;
  EXPECT_EQ(girth(after), measures_.girths[0].metres);
  const auto heights = heights_after(measures_, {mesh_, after});
  EXPECT_EQ(heights.at(0).after, heights.at(0).before.metres);
  EXPECT_EQ(heights.at(1).after, heights.at(1).before.metres);
}

TEST_F(MovedSkinTest, ATrunkMadeNarrowerHasThatMuchLessGirthWhateverTheArmsDo) {
  const auto after = moved([](const Vector3d& p) { return Vector3d(0.9 * p.x(), 0.9 * p.y(), p.z()); });
  // of the polygon, whose sides are 3e-4 shorter than the arcs
  EXPECT_NEAR(girth(after) - measures_.girths[0].metres, -0.1 * 2 * kPi * kTrunk, 4e-5);
}

TEST_F(MovedSkinTest, ATrunkMadeWiderIsFollowedBeyondItsOldTape) {
  const auto after = moved([](const Vector3d& p) { return Vector3d(1.1 * p.x(), 1.1 * p.y(), p.z()); });
  EXPECT_NEAR(girth(after) - measures_.girths[0].metres, 0.1 * 2 * kPi * kTrunk, 4e-5);
}

TEST_F(MovedSkinTest, TheGirthIsThatOfThePlaneNotOfTheSkin) {
  mesh_ = {};
  add_tube(mesh_, {0, 0, 1}, kTrunk, 0.2);  // 0.2 wider a metre below the plane
  const auto after = moved([](const Vector3d& p) { return Vector3d(p.x(), p.y(), p.z() + 0.02); });
  // what was 0.02 below and 0.004 wider is now in the plane
  EXPECT_NEAR(girth(after) - measures_.girths[0].metres, 2 * kPi * 0.2 * 0.02, 1e-4);
}

TEST_F(MovedSkinTest, ATiltedTapeIsMeasuredInItsOwnPlane) {
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(0.3, Vector3d::UnitX()));
  for (Vector3d& p : mesh_.vertices) p = tilt * p;
  for (Vector3d& p : measures_.loops[0].points) p = tilt * p;
  const auto after = moved([&](const Vector3d& p) {
    const Vector3d q = tilt.inverse() * p;
    return Vector3d(tilt * Vector3d(0.9 * q.x(), 0.9 * q.y(), q.z()));
  });
  EXPECT_NEAR(girth(after) - measures_.girths[0].metres, -0.1 * 2 * kPi * kTrunk, 4e-5);
}

TEST_F(MovedSkinTest, APostureIsNoneOfTheGarmentsDoing) {
  Spine spine;
  spine.pelvis = 1.05;
  spine.chest = 1.3;  // the tape lies where it bends
  const BoneFrames bones(spine, {0.4, 0.35});
  std::vector<Vector3d> posed = mesh_.vertices;
  for (Vector3d& p : posed) p = bones.moved(p);
  EXPECT_GT(girth(posed), 2 * kPi * kTrunk + 0.01);  // cut obliquely
  const std::vector<Vector3d> back = in_scan_posture(mesh_, posed, bones);
  EXPECT_NEAR(girth(back), 2 * kPi * kTrunk, 1e-9);
  EXPECT_NEAR(heights_after(measures_, {mesh_, back}).at(0).after.value(), 1.2, 1e-9);
  // A garment that takes a tenth of the radius off, worn in that posture.
  std::vector<Vector3d> worn =
      moved([](const Vector3d& p) { return Vector3d(0.9 * p.x(), 0.9 * p.y(), p.z()); });
  for (std::size_t v = 0; v < worn.size(); ++v) worn[v] = bones.frame_at(mesh_.vertices[v]) * worn[v];
  EXPECT_NEAR(girth(in_scan_posture(mesh_, worn, bones)), 0.9 * 2 * kPi * kTrunk, 1e-3);
}

TEST_F(MovedSkinTest, HeightsGoWhereTheirLandmarksGo) {
  const auto after =
      moved([](const Vector3d& p) { return p.x() > 0 ? Vector3d(p + Vector3d(0, 0, 0.02)) : p; });
  const auto heights = heights_after(measures_, {mesh_, after});
  EXPECT_NEAR(heights.at(0).after.value(), 1.21, 1e-12);  // one of the two by 20 mm
  EXPECT_NEAR(heights.at(1).after.value(), 1.42, 1e-12);  // and with it the highest vertex
}

TEST_F(MovedSkinTest, TheFoldsHeightIsThatOfItsLowerSide) {
  measures_.landmarks = {{"underbust_L", {kTrunk, 0, 1.22}, 0.9, ""},
                         {"underbust_R", {-kTrunk, 0, 1.2}, 0.9, ""}};
  measures_.heights = {{"underbust", 1.2, 0.9, ""}};
  const auto height_when_rises = [&](double left, double right) {
    const auto after =
        moved([&](const Vector3d& p) { return Vector3d(p + Vector3d(0, 0, p.x() > 0 ? left : right)); });
    return heights_after(measures_, {mesh_, after}).at(0).after.value();
  };
  EXPECT_NEAR(height_when_rises(0.01, 0), 1.2, 1e-12);
  EXPECT_NEAR(height_when_rises(0, 0.01), 1.21, 1e-12);
  EXPECT_NEAR(height_when_rises(0, 0.03), 1.22, 1e-12);  // the other side is the lower one then
}

TEST_F(MovedSkinTest, APointBetweenVerticesGoesAsFarAsItsPlaceOnTheSkin) {
  const Eigen::Matrix3d shear = (Eigen::Matrix3d() << 0, 0, 0, 0, 0, 0, 0.1, 0.2, 0.05).finished();
  const auto after = moved([&](const Vector3d& p) { return Vector3d(p + shear * p); });
  const Eigen::Vector3i& t = mesh_.triangles[mesh_.triangles.size() / 6];  // of the trunk
  const Vector3d place = 0.5 * mesh_.vertices[t[0]] + 0.3 * mesh_.vertices[t[1]] + 0.2 * mesh_.vertices[t[2]];
  EXPECT_LT((carried({place}, {mesh_, after}).at(0) - place - shear * place).norm(), 1e-12);
}

TEST_F(MovedSkinTest, WhatIsUnknownIsNotMadeUp) {
  const std::vector<Vector3d> after = mesh_.vertices;
  EXPECT_FALSE(girths_after(measures_, {mesh_, after}).at(1).after);   // no loop was drawn
  EXPECT_FALSE(heights_after(measures_, {mesh_, after}).at(2).after);  // no landmark of the waist
  const MovedSkin skin{mesh_, after};
  EXPECT_TRUE(tape_after(skin, {}).empty());
  EXPECT_TRUE(tape_after(skin, {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}).empty());             // no plane
  EXPECT_TRUE(tape_after(skin, {{5, 0, 9}, {6, 0, 9}, {5, 1, 9}, {4, 0, 9}}).empty());  // meets nothing
}

}  // namespace
}  // namespace tensegric_fit::geometry
