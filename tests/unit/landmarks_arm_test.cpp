// Where arms run, and armpits that the scan did not see.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "landmarks/arm_axis.hpp"
#include "landmarks/armpit.hpp"
#include "landmarks/find_landmarks.hpp"
#include "landmarks/shoulders.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

constexpr double kStature = 1.66;
constexpr double kRoofRadius = 0.125 * kStature;  // as the header of armpits says of bodies
constexpr double kRoof = 1.0;                     // height of its lowest place

// A block whose underside is an arc from front to back that leans with the arm, `lean` radians backwards as
// it goes down, and falls away to both sides as arm and trunk do; under it a web of skin, 20 mm deep and 20
// mm from front to back.
geometry::TriangleMesh armpit(double lean, bool web) {
  const auto distance = [&](const Vector3d& p) {
    const Vector3d centre(kRoofRadius * std::sin(lean), 0, kRoof + std::cos(lean) * kRoofRadius);
    const double across = p.x() - centre.x();
    const double roof = centre.z() - std::sqrt(std::max(kRoofRadius * kRoofRadius - across * across, 0.0)) -
                        p.y() * p.y() / 0.02;
    const double block =
        std::max({roof - p.z(), p.z() - kRoof - 0.10, std::abs(p.x()) - 0.05, std::abs(p.y()) - 0.06});
    if (!web) return block;
    return std::min(
        block, std::max({std::abs(p.x()) - 0.01, std::abs(p.z() - kRoof) - 0.02, std::abs(p.y()) - 0.06}));
  };
  return test::surface_of(distance, {-0.06, -0.07, 0.75}, {0.06, 0.07, 1.12}, 0.004);
}

TEST(Armpit, ARoofIsFoundUnderTheSkinThatFillsIt) {
  const landmarks::SlicedMesh sliced(armpit(0, true));
  const landmarks::FilledArmpit filled{sliced, {0, 0, kRoof - 0.02}, kStature};
  EXPECT_FALSE(landmarks::parting_is_roof(filled));
  const double height = landmarks::height_of_roof(filled);
  // Nine tenths of the block's 0.10 m are reached 5 mm above the lowest place, and a dome is 11 mm deep.
  EXPECT_NEAR(height, kRoof - 0.006, 0.002);
  const landmarks::ArmpitRoof roof = landmarks::find_armpit_roof(filled, height, 0);
  ASSERT_TRUE(roof.found);
  EXPECT_NEAR(roof.middle.x(), 0, 1e-3);  // the block is symmetric; a quarter of a mesh cell
  EXPECT_NEAR(roof.middle.y(), 0, 5e-3);  // a step between the places tried
  EXPECT_NEAR(roof.depth, 0.10, 0.002);
}

TEST(Armpit, ItsLowestPlaceWandersWithTheArm) {
  for (const double lean : {-0.1, 0.0, 0.1}) {
    const landmarks::SlicedMesh sliced(armpit(lean, false));
    const landmarks::FilledArmpit open{sliced, {0, 0, kRoof}, kStature};
    const landmarks::ArmpitRoof roof = landmarks::find_armpit_roof(open, kRoof, 0);
    ASSERT_TRUE(roof.found);
    const Vector3d arm(-std::sin(lean), 0, -std::cos(lean));
    // An arc's lowest place is under its centre, 21 mm off; less by a quarter at most, as the folds are near
    // and the arm's way is uncertain.
    const double wandered = landmarks::lowest_of_roof(roof, arm, kStature).x(),
                 centre = kRoofRadius * std::sin(lean);
    EXPECT_NEAR(wandered, centre, std::abs(centre) / 4 + 1e-3) << lean;
  }
}

TEST(Armpit, ItsLowestPlaceStaysBetweenItsFolds) {
  const landmarks::ArmpitRoof roof{true, {0.01, 0.17, kRoof}, 0.10};
  double last = -1;
  for (double lean = -1.5; lean <= 1.5; lean += 0.1) {
    const Vector3d arm(-std::sin(lean), 0, -std::cos(lean));
    const double x = landmarks::lowest_of_roof(roof, arm, kStature).x() - roof.middle.x();
    EXPECT_LT(std::abs(x), roof.depth / 2) << lean;
    if (std::abs(lean) < 0.8) {
      EXPECT_GT(x, last) << lean;  // further forward the further back the arm goes
    }
    last = x;
  }
}

TEST(Armpit, AnArmHeldOutMovesItLess) {
  const landmarks::ArmpitRoof roof{true, {0, 0.17, kRoof}, 0.10};
  const double forward = -0.1, down = 0.9;
  const Vector3d hanging(forward, std::sqrt(1 - forward * forward - down * down), -down),
      held_out(forward, std::sqrt(1 - forward * forward), 0);
  EXPECT_GT(landmarks::lowest_of_roof(roof, hanging, kStature).x(), 0);
  EXPECT_LT(landmarks::lowest_of_roof(roof, held_out, kStature).x(),
            landmarks::lowest_of_roof(roof, hanging, kStature).x());
}

TEST(Armpit, WhatWasNotFilledStaysWhereItIs) {
  const landmarks::SlicedMesh sliced(armpit(0, false));
  const landmarks::FilledArmpit open{sliced, {0, 0, kRoof}, kStature};
  EXPECT_TRUE(landmarks::parting_is_roof(open));
  EXPECT_NEAR(landmarks::height_of_roof(open), kRoof, 0.002);
}

TEST(ArmAxis, RunsAsTheArmDoes) {
  for (const double back : {-0.10, 0.0, 0.10}) {
    test::Parts parts;
    parts.hands_back = back;
    const landmarks::BodyShape body(test::person_mesh(parts));
    for (const landmarks::Side side : {landmarks::kLeft, landmarks::kRight}) {
      const double sign = landmarks::kSign[side];
      const Vector3d shoulder(0, sign * 0.19, 1.34), way(-back, sign * 0.23, -0.54);
      const landmarks::ArmAxis arm =
          landmarks::find_arm_axis(body, {{0, sign * 0.16, test::kArmpit}, 0.4, false}, side);
      ASSERT_TRUE(arm.found);
      // Middles of two sections 66 mm apart, each to a tenth of a mesh cell: 2 degrees.
      EXPECT_GT(arm.direction.dot(way.normalized()), std::cos(0.035)) << back;
      EXPECT_LT(arm.direction.cross(arm.point - shoulder).norm(), 0.003) << back;
    }
  }
}

TEST(ArmAxis, IsNotFoundWhereThereIsNoArm) {
  test::Parts parts;
  parts.arms = false;
  const landmarks::BodyShape body(test::person_mesh(parts));
  EXPECT_FALSE(
      landmarks::find_arm_axis(body, {{0, 0.16, test::kArmpit}, 0.4, false}, landmarks::kLeft).found);
}

TEST(Shoulder, LiesFurtherOutAndBehindUnderMoreFlesh) {
  const landmarks::BodyShape body(test::person_mesh({}));
  const landmarks::Trunk trunk(body);
  const landmarks::Neck neck = landmarks::find_neck(body, trunk);
  ASSERT_TRUE(neck.found);
  for (const landmarks::Side side : {landmarks::kLeft, landmarks::kRight}) {
    const landmarks::Shoulder slim = landmarks::find_shoulder(body, trunk, neck, {0, {0.22, 0.22}}, side),
                              heavy = landmarks::find_shoulder(body, trunk, neck, {0, {0.30, 0.30}}, side);
    ASSERT_TRUE(slim.found && heavy.found);
    EXPECT_GT(landmarks::kSign[side] * heavy.point.y(), landmarks::kSign[side] * slim.point.y());
    EXPECT_LT(heavy.point.x(), slim.point.x());
  }
}

TEST(Landmarks, AnArmpitThatTheScanSawKeepsItsLevel) {
  const geometry::TriangleMesh mesh = test::person_mesh({});
  const geometry::BodyMeasures surface = landmarks::find_landmarks(mesh, {}, {}),
                               scan = landmarks::find_landmarks(
                                   mesh, std::vector<char>(mesh.vertices.size(), 0), {});
  for (const char* name : {"axilla_L", "axilla_R"}) {
    const geometry::Landmark &exact = *surface.find_landmark(name), &robust = *scan.find_landmark(name);
    EXPECT_GT(robust.confidence, 0.5);
    EXPECT_NEAR(robust.position.z(), exact.position.z(), 1e-9);   // the section that parts arm and trunk
    EXPECT_LT((robust.position - exact.position).norm(), 0.010);  // ISO 20685's limit: nothing is hidden
  }
}

TEST(Landmarks, AnArmpitThatTheScanDidNotSeeIsLessCertain) {
  test::Parts parts;
  const geometry::BodyMeasures open = landmarks::find_landmarks(test::person_mesh(parts), {}, {});
  parts.web_in_armpits = 0.06;
  const geometry::TriangleMesh mesh = test::person_mesh(parts);
  std::vector<char> filled;
  for (const Vector3d& v : mesh.vertices)
    filled.push_back(std::abs(v.x()) < 0.014 && std::abs(std::abs(v.y()) - 0.17) < 0.044 &&
                     std::abs(v.z() - test::kArmpit) < parts.web_in_armpits + 0.004);
  const geometry::BodyMeasures hidden = landmarks::find_landmarks(mesh, filled, {});
  for (const char* name : {"axilla_L", "axilla_R"}) {
    EXPECT_GT(open.find_landmark(name)->confidence, 0.5);
    EXPECT_LT(hidden.find_landmark(name)->confidence, 0.5);
    EXPECT_FALSE(hidden.find_landmark(name)->reason.empty());
  }
}

}  // namespace
}  // namespace tensegric_fit
