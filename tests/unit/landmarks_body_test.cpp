// Landmarks of whole bodies of the virtual booth, whose truth is known: what holds for every body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/decimate.hpp"
#include "geometry/section.hpp"
#include "geometry/status.hpp"
#include "measured_body.hpp"
#include "virtual_booth/random_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using geometry::BodyMeasures;
using geometry::TriangleMesh;
using virtual_body::VirtualBody;
using virtual_booth::Family;

constexpr double kDegree = M_PI / 180;

struct Woman {
  VirtualBody body;
  BodyMeasures measures;
};

const Woman& woman(Family family, std::uint64_t seed) {
  static std::map<std::pair<Family, std::uint64_t>, Woman> known;
  const auto [found, is_new] = known.emplace(std::pair(family, seed), Woman());
  if (is_new) {
    found->second.body = virtual_booth::random_customer(family, seed);
    found->second.measures = test::measured(found->second.body.mesh);
  }
  return found->second;
}
const Woman& woman(std::uint64_t seed) {
  return woman(Family::model, seed);
}

const geometry::Measure& named(const std::vector<geometry::Measure>& measures, const std::string& name) {
  for (const geometry::Measure& measure : measures)
    if (measure.name == name) return measure;
  throw std::out_of_range("no " + name);
}
double girth(const BodyMeasures& measures, const std::string& name) {
  return named(measures.girths, name).metres;
}

bool is_vague(const VirtualBody& body, const std::string& figure) {
  return std::count(body.doubts.vague.begin(), body.doubts.vague.end(), figure) > 0;
}

/// m, of a landmark from its truth; along where its definition leaves it open, nothing counts.
double off(const Woman& woman, const std::string& name) {
  const Eigen::Isometry3d& frame = woman.body.truth.body_from_scan;
  Vector3d off = frame.linear() * (woman.measures.landmark(name) - woman.body.truth.landmark(name));
  for (const auto& [loose, direction] : woman.body.doubts.loose)
    if (loose == name) off -= off.dot(direction) * direction;
  return off.norm();
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  for (Vector3d& v : mesh.vertices) v = motion * v;
  return mesh;
}

double angle(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::min(1.0, a.dot(b))) / kDegree;
}

TEST(LandmarksOfBodies, OfTheModelFamilyAreWithinIso20685) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Woman& her = woman(seed);
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    for (const char* name :
         {"bust", "underbust", "hip", "waist", "neck", "upper_arm_L", "upper_arm_R", "thigh_L", "thigh_R"}) {
      if (is_vague(her.body, std::string("girth ") + name)) continue;
      const bool small = std::string(name) == "neck" || std::string(name).rfind("upper_arm", 0) == 0;
      EXPECT_NEAR(girth(her.measures, name), girth(her.body.truth, name), small ? 0.004 : 0.009) << name;
    }
    for (const char* name : {"bust", "underbust", "waist", "hip", "crotch", "neck", "stature"})
      if (!is_vague(her.body, std::string("height ") + name)) {
        EXPECT_NEAR(her.measures.height(name), her.body.truth.height(name), 0.004) << name;
      }
    for (const char* side : {"_L", "_R"}) {
      EXPECT_LT(off(her, std::string("bust_point") + side), 0.005) << side;
      for (const char* name : {"underbust", "shoulder", "neck_side", "axilla"})
        EXPECT_LT(off(her, std::string(name) + side), 0.010) << name << side;
    }
    for (const char* name : {"neck_front", "neck_back", "navel"}) EXPECT_LT(off(her, name), 0.010) << name;
    // From front to back the midline is nearly level there: its height is what counts.
    const Vector3d crotch = her.body.truth.body_from_scan.linear() *
                            (her.measures.landmark("crotch") - her.body.truth.landmark("crotch"));
    EXPECT_LT(crotch.tail<2>().norm(), 0.004);
  }
}

TEST(LandmarksOfBodies, OfShapesTheModelWasNotMadeFromAreInTheRightPlace) {
  for (const std::uint64_t seed : {1, 2, 4, 5}) {
    const Woman& her = woman(Family::implicit, seed);
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    for (const char* side : {"_L", "_R"})
      EXPECT_LT(off(her, std::string("bust_point") + side), 0.010) << side;
    for (const char* name : {"bust", "underbust", "hip", "crotch"})
      EXPECT_NEAR(her.measures.height(name), her.body.truth.height(name), 0.020) << name;
    EXPECT_NEAR(her.measures.height("stature"), her.body.truth.height("stature"), 0.004);
    for (const char* name : {"bust", "underbust", "hip"})
      EXPECT_NEAR(girth(her.measures, name), girth(her.body.truth, name), 0.015) << name;
  }
}

TEST(LandmarksOfBodies, TheFrameIsHers) {
  for (const Family family : {Family::model, Family::implicit})
    for (const std::uint64_t seed : {1, 2, 4}) {
      const Woman& her = woman(family, seed);
      const Eigen::Isometry3d difference =
          her.measures.body_from_scan * her.body.truth.body_from_scan.inverse();
      SCOPED_TRACE(her.body.family + " " + std::to_string(seed));
      EXPECT_LT(angle(difference.linear().col(0), Vector3d::UnitX()), 3);
      EXPECT_LT(angle(difference.linear().col(2), Vector3d::UnitZ()), 1);
      EXPECT_NEAR(difference.translation().z(), 0, 0.002);
      EXPECT_NEAR(difference.linear().determinant(), 1, 1e-9);
      const auto in_body = [&](const char* name) -> Vector3d {
        return her.measures.body_from_scan * her.measures.landmark(name);
      };
      EXPECT_GT(in_body("bust_point_L").y(), in_body("bust_point_R").y() + 0.1);
      EXPECT_GT(in_body("bust_point_L").x(), in_body("buttock_L").x() + 0.1);
      EXPECT_GT(in_body("neck_front").x(), in_body("neck_back").x());
    }
}

TEST(LandmarksOfBodies, EachSaysHowSureItIs) {
  for (const Family family : {Family::model, Family::implicit}) {
    const Woman& her = woman(family, 1);
    const auto expect_said = [](const std::string& name, double confidence, const std::string& reason,
                                double half_width) {
      EXPECT_TRUE(confidence > 0 && confidence <= 1) << name;
      EXPECT_TRUE(confidence >= 0.5 || !reason.empty()) << name;
      EXPECT_TRUE(half_width > 0 && half_width < 0.2) << name;
    };
    for (const auto& l : her.measures.landmarks) {
      EXPECT_TRUE(l.position.allFinite()) << l.name;
      expect_said(l.name, l.confidence, l.reason, l.half_width);
    }
    for (const auto* list : {&her.measures.heights, &her.measures.girths})
      for (const geometry::Measure& m : *list) expect_said(m.name, m.confidence, m.reason, m.half_width);
    EXPECT_EQ(her.measures.loops.size(), her.measures.girths.size());
    for (const geometry::GirthLoop& loop : her.measures.loops) {
      ASSERT_GT(loop.points.size(), 10u) << loop.name;
      // The drawn tape is the mesh's own; the figure may lean on the model.
      EXPECT_NEAR(geometry::length_of(loop.points, true), girth(her.measures, loop.name), 0.05) << loop.name;
    }
  }
}

void expect_moved_along(const Woman& her, const Eigen::Isometry3d& motion) {
  const BodyMeasures there = test::measured(moved(her.body.mesh, motion));
  ASSERT_EQ(there.landmarks.size(), her.measures.landmarks.size());
  for (const geometry::Landmark& l : her.measures.landmarks) {
    Vector3d off =
        her.body.truth.body_from_scan.linear() * (motion.inverse() * there.landmark(l.name) - l.position);
    for (const auto& [loose, direction] : her.body.doubts.loose)
      if (loose == l.name) off -= off.dot(direction) * direction;
    EXPECT_LT(off.norm(), 0.002) << l.name;
  }
  for (const geometry::Measure& m : her.measures.girths)
    EXPECT_NEAR(girth(there, m.name), m.metres, 0.002) << m.name;
  for (const geometry::Measure& m : her.measures.heights)
    EXPECT_NEAR(there.height(m.name), m.metres, 0.002) << m.name;
}

TEST(LandmarksOfBodies, GoAlongWithARigidMotion) {
  for (const std::uint64_t seed : {1, 2})
    for (const double yaw : {67.0, 190.0}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", yaw " << yaw);
      expect_moved_along(woman(seed), Eigen::Translation3d(1.3, -0.7, -1.1) *
                                          Eigen::AngleAxisd(yaw * kDegree, Vector3d::UnitZ()));
    }
}

TEST(LandmarksOfBodies, GoAlongWithATilt) {
  for (const std::uint64_t seed : {1, 2})
    for (const double towards : {0.0, 140.0}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", tilted towards " << towards);
      const Vector3d axis(-std::sin(towards * kDegree), std::cos(towards * kDegree), 0);
      expect_moved_along(woman(seed),
                         Eigen::Translation3d(0.2, 0.1, 0) * Eigen::AngleAxisd(10 * kDegree, axis));
    }
}

TEST(LandmarksOfBodies, AMirroredBodySwapsItsSides) {
  const Woman& her = woman(2);
  TriangleMesh mesh = her.body.mesh;
  for (Vector3d& v : mesh.vertices) v.y() = -v.y();
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  const BodyMeasures mirrored = test::measured(mesh);
  const auto across = [](std::string name) {
    if (name.size() > 2 && name[name.size() - 2] == '_')
      name.back() = name.back() == 'L' ? 'R' : name.back() == 'R' ? 'L' : name.back();
    return name;
  };
  // The model is only nearly its own mirror image (a millimetre), and samples lie elsewhere.
  for (const geometry::Landmark& l : her.measures.landmarks) {
    Vector3d other = mirrored.landmark(across(l.name));
    other.y() = -other.y();
    Vector3d off = other - l.position;
    for (const auto& [loose, direction] : her.body.doubts.loose)
      if (loose == l.name) off -= off.dot(direction) * direction;
    EXPECT_LT(off.norm(), 0.004) << l.name;
  }
  for (const geometry::Measure& m : her.measures.girths)
    EXPECT_NEAR(girth(mirrored, across(m.name)), m.metres, 0.002) << m.name;
  for (const geometry::Measure& m : her.measures.heights)
    EXPECT_NEAR(mirrored.height(m.name), m.metres, 0.002) << m.name;
}

TEST(LandmarksOfBodies, TheSameMeshGivesTheSameBits) {
  const Woman& her = woman(1);
  const BodyMeasures again = test::measured(her.body.mesh);
  ASSERT_EQ(again.landmarks.size(), her.measures.landmarks.size());
  for (std::size_t i = 0; i < again.landmarks.size(); ++i)
    EXPECT_EQ(again.landmarks[i].position, her.measures.landmarks[i].position);
  ASSERT_EQ(again.girths.size(), her.measures.girths.size());
  for (std::size_t i = 0; i < again.girths.size(); ++i) {
    EXPECT_EQ(again.girths[i].metres, her.measures.girths[i].metres);
    EXPECT_EQ(again.girths[i].half_width, her.measures.girths[i].half_width);
  }
  EXPECT_EQ(again.body_from_scan.matrix(), her.measures.body_from_scan.matrix());
}

TEST(LandmarksOfBodies, ACoarseMeshIsMeasuredTheSame) {
  const Woman& her = woman(4);
  const BodyMeasures coarse =
      test::measured(geometry::with_triangles(her.body.mesh, 20000));  // 10 mm wide: as booths deliver
  for (const char* side : {"_L", "_R"})
    EXPECT_LT((coarse.landmark(std::string("bust_point") + side) -
               her.body.truth.landmark(std::string("bust_point") + side))
                  .norm(),
              0.005)
        << side;
  for (const char* name : {"bust", "underbust", "hip"})
    EXPECT_NEAR(girth(coarse, name), girth(her.body.truth, name), 0.009) << name;
  for (const char* name : {"bust", "underbust", "crotch", "stature"})
    EXPECT_NEAR(coarse.height(name), her.body.truth.height(name), 0.004) << name;
}

TEST(LandmarksOfBodies, UnderwearsEdgesAreNoFolds) {
  // A bra and briefs 1.5 mm thick, whose edges are as steep as the mesh allows.
  constexpr double kThick = 0.0015;
  const Woman& bare = woman(1);
  TriangleMesh dressed = bare.body.mesh;
  const std::vector<Vector3d> normals = geometry::vertex_normals(dressed.vertices, dressed.triangles);
  const BodyMeasures& known = bare.measures;
  const double axilla = (known.body_from_scan * known.landmark("axilla_L")).y();
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Vector3d p = known.body_from_scan * dressed.vertices[v];
    const bool bra = p.z() > known.height("underbust") - 0.04 && p.z() < known.height("bust") + 0.06 &&
                     std::abs(p.y()) < axilla;
    const bool briefs = p.z() > known.height("hip") - 0.06 && p.z() < known.height("hip") + 0.08 &&
                        std::abs(p.y()) < axilla + 0.03;
    if (bra || briefs) dressed.vertices[v] += kThick * normals[v];
  }
  const BodyMeasures with = test::measured(dressed);
  for (const char* height : {"bust", "underbust", "hip", "crotch"})
    EXPECT_NEAR(with.height(height), known.height(height), 0.004) << height;
  for (const char* point : {"bust_point_L", "bust_point_R", "underbust_L", "underbust_R"})
    EXPECT_LT((with.landmark(point) - known.landmark(point)).norm(), 0.005) << point;
  // The tape runs over the cloth.
  for (const char* name : {"bust", "hip"})
    EXPECT_NEAR(girth(with, name) - girth(known, name), 2 * M_PI * kThick, 0.004) << name;
}

TEST(LandmarksOfBodies, WhatNoPointBacksIsLessSure) {
  // As a scan, all of it seen, and with half of the breast and the front of the trunk filled.
  const TriangleMesh& mesh = woman(3).body.mesh;
  const body_model::Registrar& registrar = body_model::shipped_registrar();
  const BodyMeasures& known = woman(3).measures;
  const auto scanned = [&](const std::vector<char>& filled) {
    body_model::RegisteredBody model =
        registrar(body_model::shuffled(body_model::sample_surface(mesh, filled, 40000)));
    model.ground = 0;
    return landmarks::find_landmarks(mesh, filled, model, landmarks::shipped_precision());
  };
  std::vector<char> filled;
  for (const Vector3d& v : mesh.vertices)
    filled.push_back((v - known.landmark("bust_point_L")).norm() < 0.06);
  const BodyMeasures seen = scanned({}), half_seen = scanned(filled);
  for (const char* point : {"bust_point", "underbust"})
    EXPECT_GT(half_seen.find_landmark(std::string(point) + "_L")->half_width,
              1.1 * seen.find_landmark(std::string(point) + "_L")->half_width)
        << point;
  EXPECT_GT(named(half_seen.girths, "bust").half_width, named(seen.girths, "bust").half_width);
  EXPECT_NEAR(named(half_seen.girths, "hip").half_width, named(seen.girths, "hip").half_width,
              0.1 * named(seen.girths, "hip").half_width);
  EXPECT_LT((half_seen.landmark("bust_point_L") - known.landmark("bust_point_L")).norm(),
            0.02);  // the model knows about where
}

std::string refusal_of(const TriangleMesh& mesh, const std::vector<char>& filled) {
  static const body_model::RegisteredBody model =
      body_model::register_mesh(body_model::shipped_registrar(), woman(1).body.mesh);
  try {
    landmarks::find_landmarks(mesh, filled, model, landmarks::shipped_precision());
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

// Heights are above the ground, and of a body without feet nothing shows it: they were as sure as ever, and
// off by what is missing.
TEST(LandmarksOfBodies, WithoutFeetHeightsAreAGuess) {
  const TriangleMesh& mesh = woman(2).body.mesh;
  const double cut = geometry::bounding_box(mesh.vertices)[0].z() + 0.3;
  std::vector<char> above;
  for (const Eigen::Vector3i& t : mesh.triangles)
    above.push_back(std::min({mesh.vertices[t[0]].z(), mesh.vertices[t[1]].z(), mesh.vertices[t[2]].z()}) >
                    cut);
  const BodyMeasures footless = test::measured(geometry::submesh(mesh, above));
  for (const char* name : {"bust", "hip", "stature"}) {
    const auto &before = named(woman(2).measures.heights, name), &after = named(footless.heights, name);
    EXPECT_NEAR(after.metres, before.metres, after.half_width) << name;
    EXPECT_LT(after.confidence, 0.5) << name;
    EXPECT_NE(after.reason.find("foot"), std::string::npos) << after.reason;
  }
}

TEST(LandmarksOfBodies, MeshesThatAreNoneAreRefusedByName) {
  TriangleMesh mesh = woman(1).body.mesh;
  EXPECT_EQ(refusal_of(mesh, {}), "accepted");
  EXPECT_EQ(refusal_of({}, {}), geometry::refusal::kBadMesh);
  EXPECT_EQ(refusal_of({mesh.vertices, {}}, {}), geometry::refusal::kBadMesh);
  EXPECT_EQ(refusal_of(mesh, {1, 0, 1}), geometry::refusal::kBadMesh);
  mesh.vertices[5].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal_of(mesh, {}), geometry::refusal::kNonFinite);
  mesh = woman(1).body.mesh;
  mesh.triangles[7][1] = static_cast<int>(mesh.vertices.size());
  EXPECT_EQ(refusal_of(mesh, {}), geometry::refusal::kBadMesh);
}

}  // namespace
}  // namespace tensegric_fit
