#include "inspect/overlays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "inspect/solid_lines.hpp"

namespace tensegric_fit::inspect {
namespace {

// A flat square of skin, a landmark and a tape on it, and a control mesh of the same corners.
class OverlaysTest : public testing::Test {
 protected:
  OverlaysTest() {
    body_.take_body("one", {kCorners, kTriangles});
    std::vector<Eigen::Vector3d> raised;
    for (const Eigen::Vector3d& corner : kCorners) raised.push_back(corner + Eigen::Vector3d(0, 0, 2));
    body_.take_worn({"one", "B1", raised, {1, 1, 1, 1}});

    geometry::BodyMeasures measures;
    measures.landmarks = {{"navel", {0.25, 0.25, 0}, 1, ""}, {"crotch", {0.75, 0.5, 0}, 0.2, "unsure"}};
    measures.loops = {{"waist", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}}};
    overlays_.take_measures("one", measures);
    geometry::ControlMesh control;
    control.outer = kCorners;
    control.inner = kCorners;
    control.triangles = kTriangles;
    overlays_.take_control("one", control);
    overlays_.take_model("one", model());
    overlays_.take_fit("one", raised, {{"chest", {0, 1, 2}, 0.5}});
    overlays_.take_members("one", {std::vector<Eigen::Vector3d>(8, {0, 0, 2}), {0, 1, 2, 7}, {1, -1}});
  }

  void expect_nothing_drawn() {
    EXPECT_TRUE(overlays_.dots(body_, 1).empty());
    EXPECT_TRUE(overlays_.tapes(body_, 1).empty());
    EXPECT_TRUE(overlays_.model(body_, 1).empty());
    EXPECT_TRUE(overlays_.edges(body_, 1).empty());
    EXPECT_TRUE(overlays_.lines(body_, 1).empty());
    EXPECT_TRUE(overlays_.members(body_, 1).empty());
    EXPECT_EQ(overlays_.measures(body_), nullptr);
  }

  static ModelSkin model() { return {kCorners, {{0, 1, 2, 3}}, {0, 0, 1, 1}, {"breast_L", "breast_R"}}; }

  static inline const std::vector<Eigen::Vector3d> kCorners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  static inline const std::vector<Eigen::Vector3i> kTriangles{{0, 1, 2}, {0, 2, 3}};
  BodyView body_;
  Overlays overlays_;
};

TEST_F(OverlaysTest, EverythingGoesWithTheSkin) {
  for (const double blend : {0.0, 0.5, 1.0}) {
    const double height = 2 * blend;
    const std::vector<NamedDot> dots = overlays_.dots(body_, blend);
    ASSERT_EQ(dots.size(), 2u);
    EXPECT_NEAR(dots[0].position.x(), 0.25, 1e-12);
    EXPECT_NEAR(dots[0].position.z(), height, 0.01);  // a little above the skin, to be seen
    const std::vector<Stroke> tapes = overlays_.tapes(body_, blend);
    ASSERT_EQ(tapes.size(), 1u);
    EXPECT_EQ(tapes[0].points.size(), 4u);  // closed
    EXPECT_NEAR(tapes[0].points[1].z(), height, 1e-12);
    const std::vector<Stroke> edges = overlays_.model(body_, blend);
    ASSERT_EQ(edges.size(), 4u);  // each once
    EXPECT_NEAR(edges[2].points[1].z(), height, 0.01);
    EXPECT_EQ(overlays_.edges(body_, blend).size(), 5u);
    ASSERT_EQ(overlays_.lines(body_, blend).size(), 1u);
    EXPECT_NEAR(overlays_.lines(body_, blend)[0].points[2].z(), height, 0.01);
    EXPECT_NEAR(overlays_.members(body_, blend)[1].points[1].z(), height, 1e-12);
  }
}

TEST_F(OverlaysTest, ColoursTellUnsureFromSureAndPullFromPress) {
  const std::vector<NamedDot> dots = overlays_.dots(body_, 1);
  EXPECT_EQ(dots[0].colour, kSureColour);
  EXPECT_EQ(dots[1].colour, kUnsureColour);
  const std::vector<Stroke> members = overlays_.members(body_, 1);
  EXPECT_GT(members[0].colour[0], members[0].colour[2]);  // pulls: red
  EXPECT_LT(members[1].colour[0], members[1].colour[2]);  // is pressed: blue
}

TEST_F(OverlaysTest, NothingOfAnotherScanIsDrawn) {
  body_.take_body("two", {kCorners, kTriangles});
  expect_nothing_drawn();
}

TEST_F(OverlaysTest, NothingOfAForgottenScanIsLeft) {
  overlays_.dots(body_, 1);
  overlays_.model(body_, 1);
  EXPECT_FALSE(overlays_.forget("two"));
  EXPECT_FALSE(overlays_.dots(body_, 1).empty());
  EXPECT_TRUE(overlays_.forget("one"));
  expect_nothing_drawn();
  EXPECT_FALSE(overlays_.forget("one"));
}

TEST_F(OverlaysTest, AnotherMeshOfTheSameScanIsDrawnOver) {
  EXPECT_EQ(overlays_.dots(body_, 0).size(), 2u);
  EXPECT_EQ(overlays_.model(body_, 0).size(), 4u);
  const std::vector<Eigen::Vector3d> three(kCorners.begin(), kCorners.begin() + 3);
  body_.take_body("one", {three, {{0, 1, 2}}});
  const std::vector<NamedDot> dots = overlays_.dots(body_, 0);
  ASSERT_EQ(dots.size(), 2u);
  EXPECT_NEAR(dots[0].position.x(), 0.25, 1e-12);
  for (const Stroke& stroke : overlays_.model(body_, 0))
    for (const Eigen::Vector3d& p : stroke.points) EXPECT_TRUE(p.allFinite() && p.norm() < 2);
}

TEST_F(OverlaysTest, MembersBetweenLayersGoFromRestToWorn) {
  std::vector<Eigen::Vector3d> worn(12, {0, 0, 2});  // two layers
  overlays_.take_members("one", {worn, {0, 9, 9, 5}, {1, -1}});
  const std::vector<Stroke> rest = overlays_.members(body_, 0), members = overlays_.members(body_, 1);
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_EQ(rest[0].points[1], kCorners[1]);  // half-way between outer and inner node 1, which are one here
  EXPECT_EQ(members[0].points[1], worn[9]);
  overlays_.take_members("one", {std::vector<Eigen::Vector3d>(9, {0, 0, 2}), {0, 1}, {1}});
  EXPECT_TRUE(overlays_.members(body_, 1).empty()) << "no number of nodes that this control mesh can have";
}

TEST_F(OverlaysTest, ABodyModelThatDoesNotFitItselfIsRefused) {
  const auto code_of = [this](ModelSkin skin) -> std::string {
    try {
      overlays_.take_model("one", std::move(skin));
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  };
  ModelSkin bad = model();
  bad.quads[0][2] = 4;
  EXPECT_EQ(code_of(bad), "bad_model");
  bad = model();
  bad.part[3] = 2;
  EXPECT_EQ(code_of(bad), "bad_model");
  bad = model();
  bad.part.pop_back();
  EXPECT_EQ(code_of(bad), "bad_model");
  bad = model();
  bad.vertices[0].x() = std::nan("");
  EXPECT_EQ(code_of(bad), "non_finite");
  EXPECT_EQ(overlays_.model(body_, 0).size(), 4u);  // what was there before stays
}

TEST_F(OverlaysTest, LinesStayWhileAFitIsOnItsWay) {
  overlays_.take_fit("one", kCorners, {});
  ASSERT_EQ(overlays_.lines(body_, 1).size(), 1u);
  EXPECT_NEAR(overlays_.lines(body_, 1)[0].points[0].z(), 0, 0.01);  // where the nodes are now
}

TEST_F(OverlaysTest, ABandOnTheSkinGoesFromRestToWorn) {
  const std::vector<Eigen::Vector3d> rest{{0.2, 0.1, 0}, {0.5, 0.1, 0}, {0.8, 0.1, 0}};
  std::vector<Eigen::Vector3d> worn = rest;
  for (Eigen::Vector3d& point : worn) point.z() += 1;
  overlays_.take_fit("one", kCorners, {{"chest", {}, 1, rest, worn}});
  for (const double blend : {0.0, 0.5, 1.0}) {
    const std::vector<Stroke> lines = overlays_.lines(body_, blend);
    ASSERT_EQ(lines.size(), 1u);
    ASSERT_EQ(lines[0].points.size(), 3u);
    EXPECT_NEAR(lines[0].points[1].z(), blend, 0.01);  // a little above the skin, to be seen
  }
}

TEST_F(OverlaysTest, ARibbonStandsForTheLineOfItsFit) {
  const std::vector<std::vector<Eigen::Vector3d>> rest{{{0.2, 0.1, 0}, {0.8, 0.1, 0}},
                                                       {{0.2, 0.2, 0}, {0.8, 0.2, 0}}};
  std::vector<std::vector<Eigen::Vector3d>> worn = rest;
  for (auto& fibre : worn)
    for (Eigen::Vector3d& point : fibre) point.z() += 1;
  overlays_.take_bands("one", {{"chest", 0.5, rest, worn}});
  EXPECT_TRUE(overlays_.lines(body_, 1).empty());
  const std::vector<Ribbon> ribbons = overlays_.ribbons(body_, 0.5);
  ASSERT_EQ(ribbons.size(), 1u);
  EXPECT_NEAR(ribbons[0].fibres.at(1).at(1).z(), 0.5, 0.01);
  const PaintedSurface surface = surface_of(ribbons);
  EXPECT_EQ(surface.mesh.triangles.size(), 4u) << "both sides";
  EXPECT_EQ(surface.normals.size(), surface.mesh.vertices.size());
  EXPECT_EQ(surface.colours.size(), surface.mesh.vertices.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3i& t : surface.mesh.triangles)
    sum += geometry::area_vector(surface.mesh.vertices[t[0]], surface.mesh.vertices[t[1]],
                                 surface.mesh.vertices[t[2]]);
  EXPECT_LE(sum.norm(), 1e-12);

  overlays_.take_bands("one", {{"chest", 0.7, rest, worn}});
  EXPECT_EQ(overlays_.lines(body_, 1).size(), 1u) << "the band is of another fit";
  EXPECT_THROW(overlays_.take_bands("one", {{"chest", 0.5, rest, {rest[0]}}}), geometry::Refusal);
  overlays_.take_bands("two", {{"chest", 0.5, rest, worn}});
  EXPECT_TRUE(overlays_.ribbons(body_, 1).empty());
}

TEST(SolidLines, ATubeIsClosedRoundItsLineAndFacesOutwards) {
  const std::vector<Eigen::Vector3d> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
  const PaintedSurface tube = tubes({{square, kSureColour}}, 0.01);
  ASSERT_FALSE(tube.mesh.triangles.empty());
  double volume = 0;
  for (const Eigen::Vector3i& t : tube.mesh.triangles) {
    const Eigen::Vector3d &a = tube.mesh.vertices[t[0]], &b = tube.mesh.vertices[t[1]],
                          &c = tube.mesh.vertices[t[2]];
    EXPECT_GT(
        geometry::area_vector(a, b, c).dot(tube.normals[t[0]] + tube.normals[t[1]] + tube.normals[t[2]]), 0);
    volume += a.dot(b.cross(c)) / 6;
  }
  // A hexagon of that radius along a length of 4; corners are cut a little.
  EXPECT_NEAR(volume, 4 * 1.5 * std::sqrt(3) * 1e-4, 0.35 * 4 * 1.5 * std::sqrt(3) * 1e-4);
  for (const Eigen::Vector3d& vertex : tube.mesh.vertices) {
    double off = 1;
    for (std::size_t i = 1; i < square.size(); ++i) {
      const Eigen::Vector3d along = square[i] - square[i - 1];
      const double t = std::clamp((vertex - square[i - 1]).dot(along), 0.0, 1.0);
      off = std::min(off, (vertex - square[i - 1] - t * along).norm());
    }
    EXPECT_LE(off, 0.01 + 1e-12);
  }
  EXPECT_TRUE(tubes({{{{0, 0, 0}, {0, 0, 0}}, kSureColour}}, 0.01).mesh.triangles.empty());
}

TEST_F(OverlaysTest, WhatDoesNotFitIsRefusedOrLeftOut) {
  EXPECT_THROW(overlays_.take_members("one", {kCorners, {0, 9}, {1}}), geometry::Refusal);
  EXPECT_THROW(overlays_.take_members("one", {kCorners, {0, -1}, {1}}), geometry::Refusal);
  EXPECT_THROW(overlays_.take_members("one", {kCorners, {0, 1, 2}, {1}}), geometry::Refusal);
  EXPECT_EQ(overlays_.members(body_, 1).size(), 2u);  // what was there before
  overlays_.take_fit("one", {{0, 0, 0}}, {{"chest", {0, 1}, 1}});
  EXPECT_NEAR(overlays_.lines(body_, 1)[0].points[0].z(), 0, 0.01);  // another number of nodes: at rest
  overlays_.take_fit("one", kCorners, {{"chest", {0, 99}, 1}});
  EXPECT_THROW(overlays_.lines(body_, 1), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::inspect
