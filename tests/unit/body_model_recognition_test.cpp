// What is registered: persons are taken, things and two persons refused, missing limbs and foreign surface
// named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "body_model/missing_parts.hpp"
#include "body_model/registration.hpp"
#include "geometry/decimate.hpp"
#include "geometry/status.hpp"
#include "refusal_of.hpp"
#include "shipped_model.hpp"
#include "virtual_body/model_body.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

/// A woman of the model's own make, m, z up, facing x, on the floor.
TriangleMesh woman(double arms = 30 * kDegree) {
  virtual_body::ModelBodyParameters parameters;
  parameters.shape = Eigen::VectorXd::Zero(model().components());
  parameters.shape.head<4>() << 0.8, -0.5, 0.6, -0.9;
  parameters.arms = {arms, arms};
  parameters.elbows = {0.2, 0.2};
  return {virtual_body::stand(model(), parameters).vertices, model().triangles};
}

/// Without the triangles that have a corner for which `cut` holds (index, place).
TriangleMesh without(const TriangleMesh& mesh, const std::function<bool(int, const Vector3d&)>& cut) {
  TriangleMesh result;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (cut(static_cast<int>(v), mesh.vertices[v])) continue;
    index[v] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (index[t[0]] >= 0 && index[t[1]] >= 0 && index[t[2]] >= 0)
      result.triangles.emplace_back(index[t[0]], index[t[1]], index[t[2]]);
  return result;
}

bool is_of(int vertex, const std::vector<std::string>& parts) {
  const std::string& part = model().parts[model().part[vertex]];
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

void add(TriangleMesh& mesh, const TriangleMesh& more) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles) mesh.triangles.push_back(t.array() + first);
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion) {
  for (Vector3d& v : mesh.vertices) v = motion * v;
  return mesh;
}

/// A closed surface round the z axis: `half(z)` is the half breadths along x and y, at z from 0 to `height`;
/// `corner` 2: ellipses, more: boxes with rounder and rounder corners less round.
TriangleMesh turned(double height, const std::function<Eigen::Vector2d(double)>& half, double corner = 2) {
  constexpr int kRound = 64, kHigh = 80;
  TriangleMesh mesh;
  for (int i = 0; i <= kHigh; ++i)
    for (int k = 0; k < kRound; ++k) {
      const double z = height * i / kHigh, angle = 2 * M_PI * k / kRound, c = std::cos(angle),
                   s = std::sin(angle);
      const Eigen::Vector2d r = half(z);
      const auto power = [&](double x) { return std::copysign(std::pow(std::abs(x), 2 / corner), x); };
      mesh.vertices.emplace_back(r.x() * power(c), r.y() * power(s), z);
    }
  for (int i = 0; i < kHigh; ++i)
    for (int k = 0; k < kRound; ++k) {
      const int a = i * kRound + k, b = i * kRound + (k + 1) % kRound;
      mesh.triangles.emplace_back(a, b, b + kRound);
      mesh.triangles.emplace_back(a, b + kRound, a + kRound);
    }
  for (const int end : {0, kHigh}) {
    const int centre = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(0, 0, height * end / kHigh);
    for (int k = 0; k < kRound; ++k) {
      const int a = end * kRound + k, b = end * kRound + (k + 1) % kRound;
      mesh.triangles.emplace_back(end > 0 ? a : b, end > 0 ? b : a, centre);
    }
  }
  return mesh;
}

std::string refusal_of_mesh(const TriangleMesh& mesh) {
  return refusal_of([&] { register_mesh(shipped_registrar(), mesh); });
}

std::vector<std::string> names_of(const std::vector<geometry::Missing>& missing) {
  std::vector<std::string> names;
  for (const geometry::Missing& part : missing) names.push_back(part.name);
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST(Recognition, AWholeWomanLacksNothing) {
  for (const double arms : {15.0, 45.0, 80.0}) {
    const RegisteredBody body = register_mesh(shipped_registrar(), woman(arms * kDegree));
    EXPECT_EQ(names_of(missing_parts(body)), Names()) << arms;
    EXPECT_TRUE(body.unexplained.empty()) << arms;
    EXPECT_TRUE(body.note.empty()) << body.note;
    EXPECT_LT(body.evidence.misfit, 0.002);
    EXPECT_LT(body.evidence.unexplained, 0.01);
  }
}

TEST(Recognition, ThingsAreRefused) {
  const auto round = [](double r) { return [r](double) { return Eigen::Vector2d(r, r); }; };
  const auto ball = [](double z) {
    return Eigen::Vector2d::Constant(std::sqrt(std::max(0.0, z * (1.6 - z))));
  };
  const auto cigar = [](double z) {
    return Eigen::Vector2d::Constant(0.12 * std::sqrt(std::max(0.0, 1 - std::pow(z / 0.85 - 1, 2))));
  };
  const auto snowman = [](double z) {
    const auto at = [z](double middle, double r) { return r * r - (z - middle) * (z - middle); };
    return Eigen::Vector2d::Constant(std::sqrt(std::max({0.0, at(0.35, 0.35), at(0.9, 0.28), at(1.3, 0.2)})));
  };
  EXPECT_EQ(refusal_of_mesh(turned(
                1.7, [](double) { return Eigen::Vector2d(0.25, 0.2); }, 20)),
            "not_a_body")
      << "box";
  EXPECT_EQ(refusal_of_mesh(turned(1.6, ball)), "not_a_body") << "ball";
  EXPECT_EQ(refusal_of_mesh(turned(1.5, round(0.18))), "not_a_body") << "cylinder";
  EXPECT_EQ(refusal_of_mesh(turned(1.8, round(0.04))), "not_a_body") << "pole";
  EXPECT_EQ(refusal_of_mesh(turned(1.7, cigar)), "not_a_body") << "cigar";
  EXPECT_EQ(refusal_of_mesh(turned(1.5, snowman)), "not_a_body") << "snowman";
  const Eigen::Isometry3d over(Eigen::Translation3d(0, 0, 1.65) * Eigen::AngleAxisd(M_PI, Vector3d::UnitX()));
  EXPECT_EQ(refusal_of_mesh(moved(woman(), over)), "not_a_body") << "a woman upside down";
}

TEST(Recognition, TwoPersonsAreRefusedAndTheRefusalSaysWhy) {
  for (const double yaw : {M_PI, 0.7}) {
    TriangleMesh two = woman(15 * kDegree);
    add(two, moved(two, Eigen::Translation3d(-0.5, 0, 0) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ())));
    try {
      register_mesh(shipped_registrar(), two);
      FAIL() << "two persons were taken for one";
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), std::string(geometry::refusal::kNotABody));
      EXPECT_NE(std::string(refusal.what()).find("more than one person"), std::string::npos)
          << refusal.what();
    }
  }
}

TEST(Recognition, LimbsThatAreNotThereAreNamed) {
  const TriangleMesh whole = woman();
  const auto missing_without = [&](const Names& parts) {
    return missing_parts(register_mesh(
        shipped_registrar(), without(whole, [&](int v, const Vector3d&) { return is_of(v, parts); })));
  };
  EXPECT_EQ(names_of(missing_without({"forearm_L", "hand_L"})), Names({"forearm_L"}));
  EXPECT_EQ(names_of(missing_without({"hand_R"})), Names({"hand_R"}));
  EXPECT_EQ(names_of(missing_without({"foot_L", "foot_R"})), Names({"foot_L", "foot_R"}));
  EXPECT_EQ(names_of(missing_without({"head"})), Names({"head"}));
  const auto arm = missing_without({"upper_arm_R", "forearm_R", "hand_R"});
  ASSERT_EQ(names_of(arm), Names({"upper_arm_R"}));
  for (const char* hangs_on_it : {"forearm_R", "hand_R"})
    EXPECT_NE(arm.front().reason.find(hangs_on_it), std::string::npos) << arm.front().reason;
}

// Once a forearm had come off the surface of a woman in T-pose, and nothing said so.
TEST(Recognition, ALimbThatTheSurfaceLostIsNamedThoughItWasScanned) {
  const TriangleMesh whole = woman();
  const RegisteredBody scanned = register_mesh(shipped_registrar(), whole);
  RegisteredBody body = scanned;
  mark_skin_without_surface(body, whole);
  EXPECT_EQ(body.support, scanned.support) << "nothing is lost";
  mark_skin_without_surface(body, geometry::with_triangles(whole, 3000));
  EXPECT_EQ(names_of(missing_parts(body)), Names()) << "large triangles lose no limb";
  mark_skin_without_surface(body, without(whole, [](int v, const Vector3d&) {
                              return is_of(v, {"forearm_L", "hand_L"});
                            }));
  const auto missing = missing_parts(body);
  ASSERT_EQ(names_of(missing), Names({"forearm_L"}));
  EXPECT_NE(missing.front().reason.find("hand_L"), std::string::npos) << missing.front().reason;
}

// The lost hand's skin is within 30 mm of the thigh's surface, which must not count as the hand's.
TEST(Recognition, AHandBesideTheThighThatTheSurfaceLostIsNamed) {
  const TriangleMesh whole = woman(4 * kDegree);
  const RegisteredBody scanned = register_mesh(shipped_registrar(), whole);
  for (const int triangles : {1500, 3000, 20000}) {
    RegisteredBody body = scanned;
    mark_skin_without_surface(body, geometry::with_triangles(whole, triangles));
    EXPECT_EQ(names_of(missing_parts(body)), Names()) << triangles;
  }
  RegisteredBody body = scanned;
  mark_skin_without_surface(body,
                            without(whole, [](int v, const Vector3d&) { return is_of(v, {"hand_L"}); }));
  EXPECT_EQ(names_of(missing_parts(body)), Names({"hand_L"}));
  // As it travels: 0.03 in single precision is less than 0.03.
  for (double& support : body.support) support = static_cast<float>(support);
  body.there = shares_there(body);
  EXPECT_EQ(names_of(missing_parts(body)), Names({"hand_L"}));
}

// The model's arm may then lie on the trunk, where skin is.
TEST(Recognition, AnArmThatIsNotThereIsNamedWhateverHerShape) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 4; ++n) {
    virtual_body::ModelBodyParameters parameters;
    parameters.shape = Eigen::VectorXd::Zero(model().components());
    for (int k = 0; k < 8; ++k) parameters.shape[k] = normal(random);
    parameters.arms = {25 * kDegree, 25 * kDegree};
    const TriangleMesh whole{virtual_body::stand(model(), parameters).vertices, model().triangles};
    const RegisteredBody body = register_mesh(shipped_registrar(), without(whole, [](int v, const Vector3d&) {
                                                return is_of(v, {"upper_arm_L", "forearm_L", "hand_L"});
                                              }));
    EXPECT_EQ(names_of(missing_parts(body)), Names({"upper_arm_L"})) << "seed 7, woman " << n;
    EXPECT_LT(std::acos(std::min(1.0, body.vertical.z())), 1e-9) << n;
  }
}

// Their heights were off by all of that, and sure.
TEST(Recognition, WhereTheLowestOfTheFeetIsNotThereTheGroundIsWithinItsInterval) {
  for (const double cut : {0.02, 0.03}) {
    const RegisteredBody body = register_mesh(
        shipped_registrar(), without(woman(), [&](int, const Vector3d& p) { return p.z() < cut; }));
    EXPECT_EQ(names_of(missing_parts(body)), Names()) << cut;
    EXPECT_LE(std::abs(body.ground), 1.96 * body.ground_deviation) << cut;
    EXPECT_LT(body.ground_deviation, cut) << cut;
  }
}

TEST(Recognition, HalvesOfAWomanAreRegisteredInHerSizeAndNamed) {
  const TriangleMesh whole = woman();
  struct Half {
    const char* what;
    double low, high;  ///< m, what is kept
    Names missing;
    double off;  ///< m, of the stature: the less of her the less it is known
  };
  for (const Half& half : {Half{"no legs", 0.72, 2, {"thigh_L", "thigh_R"}, 0.05},
                           Half{"no shanks", 0.43, 2, {"shank_L", "shank_R"}, 0.03},
                           Half{"no crown", 0, 1.57, {"crown"}, 0.02}}) {
    SCOPED_TRACE(half.what);
    const RegisteredBody body = register_mesh(
        shipped_registrar(),
        without(whole, [&](int, const Vector3d& p) { return p.z() < half.low || p.z() > half.high; }));
    EXPECT_EQ(names_of(missing_parts(body)), half.missing);
    EXPECT_NEAR(body.stature(), 1.64, half.off);
    EXPECT_LT(body.evidence.misfit, 0.003);
    EXPECT_LT(body.residual, 0.003) << "what is not there does not misfit";
  }
}

TEST(Recognition, WhatIsNotHersIsNamedWhereItIs) {
  TriangleMesh mesh = woman();
  // A bag, 0.24 x 0.16 x 0.30 m, behind her back.
  add(mesh, moved(turned(
                      0.30, [](double) { return Eigen::Vector2d(0.12, 0.08); }, 8),
                  Eigen::Isometry3d(Eigen::Translation3d(-0.30, 0, 1.05))));
  const RegisteredBody body = register_mesh(shipped_registrar(), mesh);
  ASSERT_EQ(body.unexplained.size(), 1U);
  EXPECT_LT((body.unexplained[0].centre - Vector3d(-0.30, 0, 1.20)).norm(), 0.1);
  EXPECT_GT(body.unexplained[0].extent, 0.25);
  EXPECT_NE(body.unexplained[0].reason.find("trunk"), std::string::npos) << body.unexplained[0].reason;
  EXPECT_EQ(names_of(missing_parts(body)), Names());
  const Eigen::Isometry3d motion(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(1, Vector3d::UnitZ()));
  EXPECT_LT((moved(body, motion).unexplained[0].centre - motion * body.unexplained[0].centre).norm(), 1e-12);
}

TEST(Recognition, AnUnusualShapeIsMeasuredWithAWord) {
  virtual_body::ModelBodyParameters parameters;
  parameters.shape = Eigen::VectorXd::Zero(model().components());
  for (int i = 0; i < model().components(); ++i) parameters.shape[i] = i % 2 == 0 ? 2.2 : -2.2;
  parameters.arms = {0.8, 0.8};
  const RegisteredBody body = register_mesh(
      shipped_registrar(), {virtual_body::stand(model(), parameters).vertices, model().triangles});
  EXPECT_NE(body.note.find("unusual"), std::string::npos) << body.evidence.shape;
}

}  // namespace
}  // namespace tensegric_fit::body_model
