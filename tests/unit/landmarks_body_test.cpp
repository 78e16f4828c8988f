// Landmarks of a person of simple shapes: known truth, and what must hold for every body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "landmarks/find_landmarks.hpp"
#include "landmarks/sliced_mesh.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using geometry::BodyMeasures;
using geometry::TriangleMesh;

constexpr double kDegree = 3.14159265358979323846 / 180;

const TriangleMesh& plain_person() {
  static const TriangleMesh mesh = test::person_mesh();
  return mesh;
}

BodyMeasures measure(const TriangleMesh& mesh) {
  return landmarks::find_landmarks(mesh, {}, {});
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  for (Vector3d& v : mesh.vertices) v = motion * v;
  return mesh;
}

Eigen::Isometry3d motion_of(double yaw, double tilt, double tilt_towards, const Vector3d& shift) {
  const Vector3d axis(-std::sin(tilt_towards), std::cos(tilt_towards), 0);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() =
      (Eigen::AngleAxisd(tilt, axis) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ())).toRotationMatrix();
  motion.translation() = shift;
  return motion;
}

double angle(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::min(1.0, a.dot(b))) / kDegree;
}

double girth(const BodyMeasures& measures, const std::string& name) {
  for (const geometry::Measure& m : measures.girths)
    if (m.name == name) return m.metres;
  ADD_FAILURE() << "no girth " << name;
  return 0;
}

std::string refusal_of(const TriangleMesh& mesh) {
  try {
    measure(mesh);
  } catch (const geometry::Refusal& refused) {
    return refused.code();
  }
  return "none";
}

TEST(Landmarks, OfASymmetricPersonAreWhereTheShapesPutThem) {
  const BodyMeasures measures = measure(plain_person());
  for (const geometry::Landmark& l : measures.landmarks) {
    EXPECT_TRUE(l.position.allFinite()) << l.name;
    EXPECT_TRUE(l.confidence >= 0.5 || !l.reason.empty()) << l.name;
  }
  // A breast without a nipple: an ellipsoid's furthest point 25 degrees outwards and 7 up. A grid of 12 mm
  // cuts the tops off by half a millimetre; the chest above melts into the breast.
  EXPECT_LT((measures.landmark("bust_point_L") - Vector3d(0.149, 0.109, 1.247)).norm(), 0.010);
  EXPECT_LT((measures.landmark("bust_point_R") - Vector3d(0.149, -0.109, 1.247)).norm(), 0.010);
  EXPECT_NEAR(measures.height("bust"), 1.247, 0.008);
  EXPECT_NEAR(measures.height("hip"), 0.90, 0.01);       // buttocks' centres
  EXPECT_NEAR(measures.height("stature"), 1.70, 0.003);  // top of the head
  EXPECT_LT(measures.height("underbust"), 1.21);         // under the breasts' middle, above their lowest skin
  EXPECT_GT(measures.height("underbust"), 1.15);
  EXPECT_GT(girth(measures, "bust"), girth(measures, "underbust"));
  EXPECT_GT(girth(measures, "underbust"), girth(measures, "waist"));
  EXPECT_NEAR(girth(measures, "neck"), 2 * 3.14159 * 0.053,
              0.035);  // a capsule of radius 50 to 55 mm, whose base melts into the shoulders
  EXPECT_NEAR(measures.landmark("crotch").y(), 0, 0.01);
  // The arm melts into the trunk over 20 mm, so its root is no sharper than that.
  EXPECT_NEAR(measures.landmark("axilla_L").z(), measures.landmark("axilla_R").z(), 0.020);
}

TEST(Landmarks, WaistIsTheTrunksLeastTape) {
  test::Parts parts;
  parts.arms = false;
  const TriangleMesh mesh = test::person_mesh(parts);
  const BodyMeasures measures = measure(mesh);
  const landmarks::SlicedMesh sliced(mesh);
  double least = 1e9;
  for (double z = measures.height("hip") + 0.1; z < measures.height("underbust") - 0.015; z += 0.001)
    least = std::min(least, landmarks::tape_length({sliced.outlines_at(z).front()}));
  EXPECT_NEAR(girth(measures, "waist"), least,
              0.002);  // chords of a 12 mm grid make girths uneven by a millimetre
}

TEST(Landmarks, FrameComesBackWhateverTheYaw) {
  const TriangleMesh& mesh = plain_person();
  const BodyMeasures still = measure(mesh);
  for (double yaw : {37.0, 143.0, 305.0}) {
    const Eigen::Isometry3d motion = motion_of(yaw * kDegree, 0, 0, {1.3, -0.7, -1.1});
    const BodyMeasures turned = measure(moved(mesh, motion));
    const Eigen::Matrix3d back = (turned.body_from_scan * motion).linear();
    EXPECT_LT(angle(back.col(0), Vector3d::UnitX()), 1.0)
        << "yaw " << yaw;  // the marching grid is not quite symmetric
    EXPECT_LT(
        ((turned.body_from_scan * motion) * Vector3d(0, 0, 0) - still.body_from_scan * Vector3d(0, 0, 0))
            .norm(),
        0.003);
    for (const char* level : {"bust", "underbust", "waist", "hip", "crotch", "neck"})
      EXPECT_NEAR(turned.height(level), still.height(level), 0.002) << level << " yaw " << yaw;
    for (const char* name : {"bust", "underbust", "waist", "hip", "neck"})
      EXPECT_NEAR(girth(turned, name), girth(still, name), 0.003) << name << " yaw " << yaw;
  }
}

TEST(Landmarks, ATiltIsTakenOut) {
  const TriangleMesh& mesh = plain_person();
  const BodyMeasures upright = measure(mesh);
  for (double towards : {0.0, 140.0}) {
    const Eigen::Isometry3d motion = motion_of(0.6, 10 * kDegree, towards * kDegree, {0.2, 0.1, 0});
    const BodyMeasures tilted = measure(moved(mesh, motion));
    const Eigen::Matrix3d back = (tilted.body_from_scan * motion).linear();
    EXPECT_LT(angle(back.col(2), Vector3d::UnitZ()), 2.5)
        << "towards " << towards;  // what soles are good for
    EXPECT_NEAR(tilted.height("bust"), upright.height("bust"), 0.010) << "towards " << towards;
  }
}

TEST(Landmarks, SolesThatAFloorMadeFlatTellUpBetterThanTheScansVertical) {
  TriangleMesh mesh = plain_person();
  for (Vector3d& v : mesh.vertices) v.z() = std::max(v.z(), 0.012);
  // Round soles, good to two degrees, would not be believed against a vertical so near.
  const Eigen::Isometry3d motion = motion_of(0.6, 1.5 * kDegree, 70 * kDegree, {0.2, 0.1, 0});
  const Eigen::Matrix3d back = (measure(moved(mesh, motion)).body_from_scan * motion).linear();
  EXPECT_LT(angle(back.col(2), Vector3d::UnitZ()), 0.1);  // the flat is exact, its rounded rim tells little
}

TEST(Landmarks, AMirroredBodySwapsItsSides) {
  test::Parts parts;
  parts.left_breast_lower = 0.015;
  const TriangleMesh mesh = test::person_mesh(parts);
  TriangleMesh mirrored = mesh;
  for (Vector3d& v : mirrored.vertices) v.y() = -v.y();
  for (Eigen::Vector3i& t : mirrored.triangles) std::swap(t[1], t[2]);
  const BodyMeasures a = measure(mesh), b = measure(mirrored);
  EXPECT_LT(a.landmark("bust_point_L").z(), a.landmark("bust_point_R").z() - 0.008);
  for (std::string name : {"bust_point", "buttock", "axilla", "shoulder", "underbust"}) {
    for (bool left : {true, false}) {
      Vector3d other = b.landmark(name + (left ? "_R" : "_L"));
      other.y() = -other.y();
      // Sections start at other triangles, so sums round otherwise; sampled places differ by less than a grid
      // cell's tenth.
      EXPECT_LT((a.landmark(name + (left ? "_L" : "_R")) - other).norm(), 0.0015) << name;
    }
  }
}

TEST(Landmarks, TheSameMeshGivesTheSameBits) {
  const TriangleMesh& mesh = plain_person();
  const BodyMeasures a = measure(mesh), b = measure(mesh);
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  for (std::size_t i = 0; i < a.landmarks.size(); ++i)
    EXPECT_EQ(a.landmarks[i].position, b.landmarks[i].position);
  for (std::size_t i = 0; i < a.girths.size(); ++i) EXPECT_EQ(a.girths[i].metres, b.girths[i].metres);
}

TEST(Landmarks, SkinThatFillsTheGapBetweenTheThighsDoesNotLowerTheCrotch) {
  test::Parts filled;
  filled.web_below_crotch = 0.05;
  const BodyMeasures open = measure(plain_person()), web = measure(test::person_mesh(filled));
  EXPECT_NEAR(web.height("crotch"), open.height("crotch"), 0.010);
  EXPECT_LT(web.find_landmark("crotch")->confidence, 0.5);
  EXPECT_FALSE(web.find_landmark("crotch")->reason.empty());
}

TEST(Landmarks, SkinThatFillsALittleOfTheSlitBetweenTheLegsDoesNotLowerTheCrotch) {
  test::Parts parts;
  const double open = measure(plain_person()).height("crotch");
  for (const double web : {0.015, 0.025}) {  // the skin alone is 14 and 24 mm lower
    parts.web_below_crotch = web;
    EXPECT_NEAR(measure(test::person_mesh(parts)).height("crotch"), open, 0.006)  // half a cell of the grid
        << "web " << web;
  }
}

TEST(Landmarks, AHeadHeldForwardTakesTheNeckAlong) {
  const BodyMeasures upright = measure(plain_person());
  test::Parts parts;
  parts.head_forward = 0.04;
  const BodyMeasures stooped = measure(test::person_mesh(parts));
  // A capsule of radius 50 to 55 mm, cut square to it; level, its section is 10 mm longer.
  EXPECT_NEAR(girth(stooped, "neck"), 2 * 3.14159 * 0.053, 0.008);
  EXPECT_GT(stooped.landmark("neck_front").x(), upright.landmark("neck_front").x() + 0.005);
  EXPECT_LT(stooped.landmark("neck_front").z(), stooped.height("neck"));
}

TEST(Landmarks, SkinThatFillsTheGapUnderAHangingBreastDoesNotLowerTheFold) {
  test::Parts parts;
  parts.breasts_hang = true;
  const BodyMeasures open = measure(test::person_mesh(parts));
  parts.web_below_fold = 0.015;
  const BodyMeasures web = measure(test::person_mesh(parts));
  // Half a cell of the grid, of 12 mm; the web alone is 12 mm lower. The girth changes by 2 mm a mm there.
  EXPECT_NEAR(web.height("underbust"), open.height("underbust"), 0.006);
  EXPECT_NEAR(girth(web, "underbust"), girth(open, "underbust"), 0.015);
  EXPECT_LT(web.find_landmark("underbust_R")->confidence, 0.5);
}

TEST(Landmarks, AHandBesideThighsThatTouchIsNotMeasuredWithThem) {
  test::Parts parts;
  parts.web_below_crotch = 0.12;
  const BodyMeasures alone = measure(test::person_mesh(parts));
  parts.hand_beside_thigh = true;
  const BodyMeasures beside = measure(test::person_mesh(parts));
  EXPECT_LT(alone.find_landmark("crotch")->confidence, 0.5);             // else nothing touches
  EXPECT_NEAR(girth(beside, "thigh_L"), girth(alone, "thigh_L"), 1e-3);  // another yaw by a hand's weight
}

TEST(Landmarks, AMannequinWithoutHeadAndArmsIsMeasuredAsFarAsItGoes) {
  test::Parts parts;
  parts.head = parts.arms = false;
  const BodyMeasures measures = measure(test::person_mesh(parts));
  EXPECT_EQ(measures.find_landmark("axilla_L"), nullptr);
  for (const std::string name : {"axilla_L", "axilla_R", "neck_front", "neck", "shoulder_L", "upper_arm_R"}) {
    const auto same = [&name](const geometry::Missing& m) { return m.name == name && !m.reason.empty(); };
    EXPECT_TRUE(std::any_of(measures.missing.begin(), measures.missing.end(), same)) << name;
  }
  EXPECT_NEAR(measures.height("bust"), 1.247, 0.01);
  EXPECT_GT(girth(measures, "waist"), 0.5);
}

// The spine bends forward from the waist up to the axillae; what is above, arms too, goes along as it is.
Vector3d stooped(const Vector3d& p, double angle) {
  const double low = 1.00, high = 1.28;
  double x = 0, z = low, bent = 0;
  const double arm = std::clamp((std::abs(p.y()) - 0.14) / 0.06, 0.0, 1.0);  // arms hang from above
  const double spine = (1 - arm) * std::clamp(p.z(), low, high) + arm * high;
  if (spine > low) {
    const int steps = 100;
    for (int i = 0; i < steps; ++i) {
      bent = angle * (i + 0.5) / steps * (spine - low) / (high - low);
      x += std::sin(bent) * (spine - low) / steps;
      z += std::cos(bent) * (spine - low) / steps;
    }
    bent = angle * (spine - low) / (high - low);
  } else {
    z = spine;
  }
  const double up = p.z() - spine;
  return {x + p.x() * std::cos(bent) + up * std::sin(bent), p.y(),
          z - p.x() * std::sin(bent) + up * std::cos(bent)};
}

TEST(Landmarks, OfTheUpperTrunkGoAlongWithAStoop) {
  const BodyMeasures upright = measure(plain_person());
  for (double angle : {12.0, 22.0}) {
    TriangleMesh mesh = plain_person();
    for (Vector3d& v : mesh.vertices) v = stooped(v, angle * kDegree);
    const BodyMeasures bent = measure(mesh);
    // Skin marks are where the bend took them. ISO 20685 gives points 10 mm; this round figure's arms melt
    // into the trunk, so that its axillae, which tell half of the shoulders' breadth, are less sharp.
    for (const char* name : {"neck_back", "neck_side_L", "neck_side_R"})
      EXPECT_LT((bent.landmark(name) - stooped(upright.landmark(name), angle * kDegree)).norm(), 0.012)
          << name << " at " << angle;
    for (const char* name : {"shoulder_L", "shoulder_R"})
      EXPECT_LT((bent.landmark(name) - stooped(upright.landmark(name), angle * kDegree)).norm(), 0.028)
          << name << " at " << angle;
    // A throat without a clear notch: 1 mm further along the neck is 1 to 2 mm of girth.
    EXPECT_NEAR(girth(bent, "neck"), girth(upright, "neck"), 0.007) << angle;
  }
}

TEST(Landmarks, ArmsMayBeHeldOut) {
  test::Parts parts;
  parts.arms_out = true;
  const BodyMeasures hanging = measure(plain_person()), out = measure(test::person_mesh(parts));
  for (const char* name : {"bust_point_L", "bust_point_R", "neck_back", "crotch"})
    EXPECT_LT((out.landmark(name) - hanging.landmark(name)).norm(), 0.005) << name;
  for (const char* name :
       {"bust", "underbust", "waist", "hip", "neck"})  // the arms' roots melt into the neck
    EXPECT_NEAR(girth(out, name), girth(hanging, name), 0.006) << name;
  for (const char* name : {"shoulder_L", "shoulder_R"})
    // A real collarbone rises with the arm, by 22 mm towards the neck; this figure has none, and its shoulder
    // is a ball, which falls away steeply: so only sideways.
    EXPECT_NEAR(out.landmark(name).y(), hanging.landmark(name).y(), 0.030) << name;
}

TEST(Landmarks, ABellyIsNoBreast) {
  test::Parts parts;
  parts.belly = 0.03;
  const BodyMeasures slim = measure(plain_person()), round = measure(test::person_mesh(parts));
  for (const char* name : {"bust_point_L", "bust_point_R"})  // the belly's top melts into the breasts
    EXPECT_LT((round.landmark(name) - slim.landmark(name)).norm(), 0.012) << name;
  EXPECT_GT(girth(round, "waist"), girth(slim, "waist") + 0.1);
}

TEST(Landmarks, UnderwearsEdgesAreNoFolds) {
  // A bra and briefs 1.5 mm thick, whose edges are as steep as the mesh allows.
  constexpr double kThick = 0.0015;
  const TriangleMesh& bare = plain_person();
  TriangleMesh dressed = bare;
  const std::vector<Vector3d> normals = geometry::vertex_normals(bare.vertices, bare.triangles);
  const auto within = [](double z, double low, double high) { return z > low && z < high; };
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vector3d& p = bare.vertices[v];
    if (std::abs(p.y()) < 0.19 && (within(p.z(), 1.15, 1.30) || within(p.z(), 0.83, 0.97)))
      dressed.vertices[v] += kThick * normals[v];
  }
  const BodyMeasures without = measure(bare), with = measure(dressed);
  for (const char* height : {"bust", "underbust", "hip", "crotch"})
    EXPECT_NEAR(with.height(height), without.height(height), 0.002) << height;
  for (const char* point : {"bust_point_L", "bust_point_R", "navel", "buttock_L", "buttock_R"})
    EXPECT_LT((with.landmark(point) - without.landmark(point)).norm(), 0.003) << point;
  // The tape runs over the cloth; a millimetre for the chords of a 12 mm grid.
  for (const char* name : {"bust", "hip"})
    EXPECT_NEAR(girth(with, name) - girth(without, name), 2 * M_PI * kThick, 0.001) << name;
  EXPECT_NEAR(girth(with, "waist"), girth(without, "waist"), 0.001);
}

TEST(Landmarks, AnAxillaIsFoundForEachPoseOfTheArm) {
  for (const bool out : {false, true}) {
    test::Parts parts;
    parts.arms_out = out;
    const BodyMeasures measures = measure(test::person_mesh(parts));
    for (const char* name : {"axilla_L", "axilla_R"}) {
      // Under the arm's root (45 mm thick, centred 0.19 m out at 1.34 m) and outside the chest, 0.15 m.
      const Vector3d& axilla = measures.landmark(name);
      EXPECT_GT(std::abs(axilla.y()), 0.12) << name << out;
      EXPECT_LT(std::abs(axilla.y()), 0.24) << name << out;
      EXPECT_NEAR(axilla.z(), 1.27, 0.04) << name << out;
    }
  }
}

TEST(Landmarks, AnAxillaStaysUnderAnArmThatIsHeldOutLevelOrHigher) {
  test::Parts parts;
  parts.arms_out = true;
  const BodyMeasures low = measure(test::person_mesh(parts));
  for (const double higher : {0.05, 0.10, 0.15}) {  // the upper arm's underside rises outwards from 0.11 on
    parts.hands_higher = higher;
    const BodyMeasures measures = measure(test::person_mesh(parts));
    for (const char* name : {"axilla_L", "axilla_R"})
      // The corner of arm and trunk opens by some degrees: a few millimetres of its round, 20 mm wide.
      EXPECT_LT((measures.landmark(name) - low.landmark(name)).norm(), 0.015) << name << higher;
    for (const char* name : {"upper_arm_L", "upper_arm_R"})  // a capsule, 45 mm thick at the shoulder
      EXPECT_NEAR(girth(measures, name), girth(low, name), 0.010) << higher;
    for (const char* name : {"bust", "underbust", "waist", "hip"})
      EXPECT_NEAR(girth(measures, name), girth(low, name), 0.002) << name << higher;
  }
}

TEST(Landmarks, ASideWithoutAnArmIsToldByTheOther) {
  TriangleMesh mesh = plain_person();
  const BodyMeasures both = measure(mesh);
  test::Parts parts;
  parts.right_arm = false;
  const BodyMeasures one = measure(test::person_mesh(parts));
  EXPECT_EQ(one.find_landmark("axilla_R"), nullptr);
  EXPECT_LT((one.landmark("axilla_L") - both.landmark("axilla_L")).norm(), 0.002);
  EXPECT_LT((one.landmark("shoulder_L") - both.landmark("shoulder_L")).norm(), 0.010);
}

TEST(Landmarks, GirthsOfLimbsAreSquareToThem) {
  const BodyMeasures measures = measure(plain_person());
  // The arm's radius falls from 45 to 30 mm over 586 mm, the thigh's from 80 to 45 mm over 750 mm. A grid of
  // 12 mm cuts round shapes by half a millimetre of radius.
  for (const char* name : {"upper_arm_L", "upper_arm_R"}) {
    EXPECT_LT(girth(measures, name), 2 * 3.14159 * 0.045) << name;
    EXPECT_GT(girth(measures, name), 2 * 3.14159 * 0.037) << name;
  }
  EXPECT_NEAR(girth(measures, "thigh_L"), 2 * 3.14159 * 0.077, 0.02);
  EXPECT_NEAR(girth(measures, "thigh_R"), girth(measures, "thigh_L"), 0.005);
}

TEST(Landmarks, FilledSkinIsLessCertain) {
  const TriangleMesh& mesh = plain_person();
  std::vector<char> filled(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < filled.size(); ++v)
    filled[v] = mesh.vertices[v].x() > 0.12 && mesh.vertices[v].y() > 0;
  const BodyMeasures measures = landmarks::find_landmarks(mesh, filled, {});
  EXPECT_LT(measures.find_landmark("bust_point_L")->confidence, 0.5);
  EXPECT_GE(measures.find_landmark("bust_point_R")->confidence, 0.5);
}

TEST(Landmarks, AGirthSaysHowFarItCanBeOff) {
  const TriangleMesh& mesh = plain_person();
  std::vector<char> filled(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < filled.size(); ++v) filled[v] = mesh.vertices[v].x() < 0;
  const BodyMeasures seen = measure(mesh), half_seen = landmarks::find_landmarks(mesh, filled, {});
  ASSERT_EQ(seen.girths.size(), half_seen.girths.size());
  for (std::size_t i = 0; i < seen.girths.size(); ++i) {
    EXPECT_GT(seen.girths[i].half_width, 0) << seen.girths[i].name;
    EXPECT_GE(half_seen.girths[i].half_width, seen.girths[i].half_width) << seen.girths[i].name;
  }
  // The whole back 5 mm off changes a girth by half of 2 pi times 5 mm.
  const auto hip = std::find_if(half_seen.girths.begin(), half_seen.girths.end(),
                                [](const geometry::Measure& m) { return m.name == "hip"; });
  ASSERT_NE(hip, half_seen.girths.end());
  EXPECT_GT(hip->half_width, 0.008);
  EXPECT_LT(hip->half_width, 0.025);
}

TEST(Landmarks, WhatIsNoStandingBodyIsRefused) {
  const auto mesh = [](const test::Distance& d) {
    return test::surface_of(d, {-0.55, -0.55, -0.05}, {0.55, 0.55, 1.75}, 0.03);
  };
  EXPECT_EQ(refusal_of(TriangleMesh()), "not_a_body");
  const TriangleMesh box = mesh([](const Vector3d& p) {
    return std::max({std::abs(p.x()) - 0.2, std::abs(p.y()) - 0.3, std::abs(p.z() - 0.85) - 0.84});
  });
  EXPECT_EQ(refusal_of(box), "not_a_body");
  EXPECT_EQ(refusal_of(mesh([](const Vector3d& p) { return (p - Vector3d(0, 0, 0.6)).norm() - 0.5; })),
            "not_a_body");
  const TriangleMesh fish = mesh([](const Vector3d& p) {  // on its tail, which has two tips
    double d = test::ellipsoid(p, {0, 0, 1.0}, {0.08, 0.2, 0.7});
    for (double side : {1.0, -1.0})
      d = test::melt(d, test::capsule(p, {0, 0, 0.35}, {0, side * 0.2, 0.1}, 0.05, 0.04));
    return d;
  });
  EXPECT_EQ(refusal_of(fish), "not_a_body");

  const TriangleMesh& person = plain_person();
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() = Eigen::AngleAxisd(180 * kDegree, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(refusal_of(moved(person, turned)), "not_a_body");
  try {
    measure(moved(person, turned));
  } catch (const geometry::Refusal& refused) {
    EXPECT_NE(std::string(refused.what()).find("upside down"), std::string::npos) << refused.what();
  }
  turned.linear() = Eigen::AngleAxisd(90 * kDegree, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(refusal_of(moved(person, turned)), "not_a_body") << "lying";
  TriangleMesh in_millimetres = person;
  for (Vector3d& v : in_millimetres.vertices) v *= 1000;
  EXPECT_EQ(refusal_of(in_millimetres), "wrong_unit");
}

}  // namespace
}  // namespace tensegric_fit
