#include <gtest/gtest.h>

#include <cmath>

#include "geometry/posture.hpp"
#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

// A person who faces along scan's -y, with her soles at z = 0.1.
BodyMeasures measures() {
  BodyMeasures m;
  m.body_from_scan = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()) * Eigen::Translation3d(-0.3, 0.2, -0.1);
  m.heights = {{"hip", 0.85, 1, ""}, {"underbust", 1.11, 1, ""}};
  m.landmarks = {{"crotch", m.body_from_scan.inverse() * Vector3d(-0.02, 0.01, 0.77), 1, ""}};
  return m;
}

// Points of the body frame in the scan's, and back.
Vector3d in_scan(double x, double y, double z) {
  return measures().body_from_scan.inverse() * Vector3d(x, y, z);
}

std::string refusal_of_posing(const BodyMeasures& m, const Posture& posture = {0.1, 0.1}) {
  try {
    BoneFrames(m, posture);
  } catch (const Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

Eigen::Matrix3d jacobian(const BoneFrames& bones, const Vector3d& p) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i)
    result.col(i) =
        (bones.moved(p + kStep * Vector3d::Unit(i)) - bones.moved(p - kStep * Vector3d::Unit(i))) /
        (2 * kStep);
  return result;
}

TEST(Posture, StillBonesAndNoShareMoveNothing) {
  const Vector3d p = in_scan(0.1, 0.05, 1.2);
  EXPECT_TRUE(BoneFrames().still());
  EXPECT_EQ(BoneFrames().moved(p), p);
  EXPECT_TRUE(BoneFrames(measures(), {}).still());
  EXPECT_EQ(BoneFrames(measures(), {}).moved(p), p);
  const BoneFrames bones(measures(), {0.5, -0.4});
  EXPECT_FALSE(bones.still());
  EXPECT_EQ(bones.moved(p, 0), p);
  EXPECT_NE(bones.moved(p), p);
}

TEST(Posture, PelvisAndLegsStay) {
  const BoneFrames bones(measures(), {0.5, 0.4});
  for (double z : {0.0, 0.4, 0.85}) {
    const Vector3d p = in_scan(0.07, -0.15, z);
    EXPECT_EQ(bones.moved(p), p);
  }
}

TEST(Posture, TheChestTurnsAndLeansAsOneByTheAnglesAskedFor) {
  const double twist = 30 * kDegree, lean = 20 * kDegree;
  const BoneFrames bones(measures(), {twist, lean});
  const Eigen::Isometry3d frame = bones.frame_at(in_scan(0, 0, 1.3));
  for (const Vector3d& p : {in_scan(0.1, 0.12, 1.11), in_scan(-0.1, 0.2, 1.4), in_scan(0, 0, 1.7)})
    EXPECT_LT((bones.moved(p) - frame * p).norm(), 1e-14);  // rounding
  const Eigen::Matrix3d to_body = measures().body_from_scan.linear();
  const Eigen::Matrix3d turn = to_body * frame.linear() * to_body.transpose();
  EXPECT_NEAR(std::atan2(turn(1, 2), turn(2, 2)), lean, 1e-14);    // her vertical tips to her left (y)
  EXPECT_NEAR(turn(0, 2), 0, 1e-14);                               // and not forwards
  EXPECT_NEAR(std::atan2(-turn(0, 1), turn(0, 0)), twist, 1e-14);  // her front turns to her left
  EXPECT_GT(turn(1, 0), 0);
  const BoneFrames half(measures(), {twist / 2, lean / 2});
  EXPECT_LT((bones.moved(in_scan(0, 0, 1), 0.5) - half.moved(in_scan(0, 0, 1))).norm(), 1e-14);
}

TEST(Posture, LeaningToTheOtherSideIsTheMirrorImage) {
  const BoneFrames left(measures(), {0.3, 0.4}), right(measures(), {-0.3, -0.4});
  const auto mirrored = [](const Vector3d& p) {
    Vector3d q = measures().body_from_scan * p;
    q.y() = 0.02 - q.y();  // the spine is at y = 0.01
    return Vector3d(measures().body_from_scan.inverse() * q);
  };
  for (double z : {0.9, 1.0, 1.1, 1.3}) {
    const Vector3d p = in_scan(0.08, 0.11, z);
    EXPECT_LT((right.moved(mirrored(p)) - mirrored(left.moved(p))).norm(), 1e-14);
  }
}

TEST(Posture, NoTearAndNoKinkAtAnyHeight) {
  const BoneFrames bones(measures(), {kLargestTwist, kLargestLean});
  for (double z : {0.85, 0.93, 1.0, 1.11}) {
    const Vector3d below = in_scan(0.1, 0.1, z - 1e-5), above = in_scan(0.1, 0.1, z + 1e-5);
    EXPECT_LT((bones.moved(above) - bones.moved(below)).norm(), 4e-5);
    // The angle's second derivative is 6 / 0.26^2 rad/m^2 at most, at arms of 0.15 m and angles of 1.05 +
    // 0.7: 23 per metre, over 2e-5 m.
    EXPECT_LT((jacobian(bones, above) - jacobian(bones, below)).norm(), 1e-3);
  }
}

TEST(Posture, NothingTurnsOverUpToTheLimits) {
  for (double twist : {-kLargestTwist, 0.0, kLargestTwist})
    for (double lean : {-kLargestLean, 0.0, kLargestLean}) {
      const BoneFrames bones(measures(), {twist, lean});
      for (double z = 0.8; z < 1.3; z += 0.01)
        for (double y = -0.18; y < 0.2; y += 0.06)  // the width of the hips
          for (double x : {-0.12, 0.0, 0.1})
            EXPECT_GT(jacobian(bones, in_scan(x, y, z)).determinant(), 0.05) << z << " " << y;
    }
}

TEST(Posture, VolumeOfATrunkIsKept) {
  // An elliptic tube round the spine, from the knees to the shoulders.
  TriangleMesh tube;
  constexpr int kRings = 400, kSectors = 120;
  for (int i = 0; i <= kRings; ++i)
    for (int k = 0; k < kSectors; ++k) {
      const double angle = 2 * M_PI * k / kSectors;
      tube.vertices.push_back(
          in_scan(-0.02 + 0.1 * std::cos(angle), 0.01 + 0.15 * std::sin(angle), 0.5 + 0.9 * i / kRings));
    }
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kSectors; ++k) {
      const int a = kSectors * i + k, b = kSectors * i + (k + 1) % kSectors;
      tube.triangles.emplace_back(a, b, b + kSectors);
      tube.triangles.emplace_back(a, b + kSectors, a + kSectors);
    }
  for (int k = 1; k + 1 < kSectors; ++k) {
    const int top = kSectors * kRings;
    tube.triangles.emplace_back(0, k + 1, k);
    tube.triangles.emplace_back(top, top + k, top + k + 1);
  }
  ASSERT_TRUE(is_closed(tube));
  const double before = cone_volume(tube.vertices, tube.triangles);
  for (const Posture& posture : {Posture{kLargestTwist, 0}, Posture{0, kLargestLean}, Posture{0.5, -0.4}}) {
    const BoneFrames bones(measures(), posture);
    std::vector<Vector3d> moved;
    for (const Vector3d& p : tube.vertices) moved.push_back(bones.moved(p));
    EXPECT_NEAR(cone_volume(moved, tube.triangles) / before, 1, 1e-4);  // flat triangles of 2 mm x 8 mm
  }
}

TEST(Posture, AMessageCarriesItWhole) {
  const BoneFrames bones(measures(), {0.4, -0.2});
  const BoneFrames copy(bones.spine(), bones.posture());
  const Vector3d p = in_scan(0.1, 0.1, 1.02);
  EXPECT_EQ(copy.moved(p), bones.moved(p));
}

TEST(Posture, RefusalsHaveNames) {
  EXPECT_EQ(refusal_of_posing(measures()), "accepted");
  EXPECT_EQ(refusal_of_posing(measures(), {1.1, 0}), "bad_option");
  EXPECT_EQ(refusal_of_posing(measures(), {0, -0.8}), "bad_option");
  EXPECT_EQ(refusal_of_posing(measures(), {std::nan(""), 0}), "bad_option");
  BodyMeasures m = measures();
  m.heights.pop_back();
  EXPECT_EQ(refusal_of_posing(m), "missing_part:underbust");
  m = measures();
  m.heights.erase(m.heights.begin());
  EXPECT_EQ(refusal_of_posing(m), "missing_part:hip");
  m = measures();
  m.landmarks.clear();
  EXPECT_EQ(refusal_of_posing(m), "missing_part:crotch");
  m = measures();
  m.heights[1].metres = 0.8;
  EXPECT_EQ(refusal_of_posing(m), "not_a_body");
}

}  // namespace
}  // namespace tensegric_fit::geometry
