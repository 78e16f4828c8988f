// Unit and axes from the body: every unit, every axis, any yaw; what fits two readings is refused and says
// both.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/status.hpp"
#include "mesh_files/reading.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// Points around a vertical ellipse's walls between two heights.
void add_wall(Points& points, Vector3d low, Vector3d high, double a, double b) {
  for (int i = 0; i < 60; ++i)
    for (int k = 0; k < 40; ++k)
      points.push_back(low + (high - low) * (i / 59.0) +
                       Vector3d(a * std::cos(k * M_PI / 20), b * std::sin(k * M_PI / 20), 0));
}

// A standing figure, 1.7 m, z up: legs, trunk, arms a little away, neck and head.
Points figure(double arms_out = 0.1) {
  Points points;
  for (double side : {-1.0, 1.0}) {
    add_wall(points, {0, 0.10 * side, 0}, {0, 0.08 * side, 0.8}, 0.06, 0.06);
    add_wall(points, {0, 0.2 * side, 1.4}, {0, (0.2 + arms_out) * side, 0.75}, 0.04, 0.04);
  }
  add_wall(points, {0, 0, 0.8}, {0, 0, 1.42}, 0.11, 0.18);
  add_wall(points, {0, 0, 1.42}, {0, 0, 1.7}, 0.08, 0.07);
  return points;
}

const Kind kMesh{true, ""};

TEST(Reading, FindsUnitAndAxes) {
  for (const char* unit : {"m", "cm", "mm", "inch"}) {
    for (const char* up : {"x", "y", "z", "-x", "-y", "-z"}) {
      for (double yaw : {0.0, 0.6, 1.57, 3.0}) {
        Reading truth;
        truth.unit = unit;
        truth.up = up;
        Points file;
        for (const Vector3d& p : figure())
          file.push_back(truth.turn().transpose() * (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * p) /
                         truth.metres());
        const Reading found = infer_reading(file, kMesh, {});
        EXPECT_EQ(found.unit, unit) << up << yaw;
        EXPECT_EQ(found.up, up) << unit << yaw;
      }
    }
  }
}

TEST(Reading, TurnsAreRotationsThatBringUpToZ) {
  for (const char* up : {"x", "y", "z", "-x", "-y", "-z"}) {
    Reading reading;
    reading.up = up;
    EXPECT_NEAR(reading.turn().determinant(), 1, 1e-12);
    Vector3d axis = Vector3d::Unit(reading.up.back() - 'x');
    if (reading.up.front() == '-') axis = -axis;
    EXPECT_EQ(reading.turn() * axis, Vector3d::UnitZ());
  }
  EXPECT_TRUE(Reading().turn().isIdentity(0));
}

// One leg ends below the knee, or a foot is lifted: a second leg beside the lowest foot is no shoulder.
TEST(Reading, OneFootIsNoHead) {
  for (const double ends : {0.25, 0.45}) {
    Points points;
    for (const Vector3d& p : figure())
      if (p.y() > -0.03 || p.z() > ends || std::abs(p.y()) > 0.17) points.push_back(p);
    EXPECT_EQ(infer_reading(points, kMesh, {}).up, "z") << ends;
    for (Vector3d& p : points) p.z() = -p.z();
    EXPECT_EQ(infer_reading(points, kMesh, {}).up, "-z") << ends;
  }
}

TEST(Reading, ArmsStraightOutAreNoUp) {
  Points points = figure(0);
  for (double side : {-1.0, 1.0})
    for (int i = 0; i < 4000; ++i)
      points.emplace_back(0.03 * std::cos(i), side * (0.2 + 0.65 * i / 4000), 1.38 + 0.03 * std::sin(i));
  EXPECT_EQ(infer_reading(points, kMesh, {}).up, "z");
}

TEST(Reading, AFloorDoesNotLayACloudDown) {
  Points points = figure();
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 40; ++k) points.emplace_back(0.06 * i - 1.2, 0.06 * k - 1.2, 0);
  const Reading reading = infer_reading(points, {}, {});
  EXPECT_TRUE(reading.is_identity());
}

std::string refused(const Points& points, const Kind& kind, const Asked& asked,
                    std::string* message = nullptr) {
  try {
    infer_reading(points, kind, asked);
  } catch (const geometry::Refusal& refusal) {
    if (message != nullptr) *message = refusal.what();
    return refusal.code();
  }
  return "accepted";
}

TEST(Reading, WhatFitsTwoReadingsIsRefusedAndSaysBoth) {
  Points trunk;  // 100 across: 1 m in cm, 2.5 m in inch
  add_wall(trunk, {0, 0, 0}, {0, 0, 100}, 20, 30);
  std::string message;
  EXPECT_EQ(refused(trunk, kMesh, {}, &message), "wrong_unit");
  EXPECT_NE(message.find("cm"), std::string::npos);
  EXPECT_NE(message.find("inch"), std::string::npos);
  EXPECT_EQ(message.find("--"), std::string::npos) << "not each program that says it has options";
  EXPECT_EQ(refused(trunk, kMesh, {"cm", ""}), "accepted");
  EXPECT_EQ(refused(trunk, kMesh, {"m", ""}, &message), "wrong_unit");
  EXPECT_NE(message.find("100 m across"), std::string::npos) << message;
  EXPECT_EQ(refused({{0, 0, 0}, {0, 0, 1.7}}, kMesh, {"mm", ""}), "wrong_unit");  // 1.7 mm

  Points post;  // neither end is a head
  add_wall(post, {0, 0, 0}, {0, 0, 1.7}, 0.15, 0.15);
  EXPECT_EQ(refused(post, kMesh, {}, &message), "wrong_axes");
  EXPECT_NE(message.find("-z"), std::string::npos);
  EXPECT_EQ(message.find("--"), std::string::npos);
  EXPECT_EQ(refused(post, kMesh, {"", "-z"}), "accepted");
  EXPECT_EQ(infer_reading(post, {true, "z"}, {}).up, "z");  // a format that has a usual up

  EXPECT_EQ(refused({{0, 0, 0}, {0, 0, 1e6}}, kMesh, {}), "wrong_unit");
  EXPECT_EQ(refused(post, kMesh, {"foot", ""}), "bad_option");
  EXPECT_EQ(refused(post, kMesh, {"", "w"}), "bad_option");
}

}  // namespace
}  // namespace tensegric_fit::mesh_files
