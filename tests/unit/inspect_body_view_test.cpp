#include "inspect/body_view.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "geometry/status.hpp"

namespace tensegric_fit::inspect {
namespace {

using Vertices = std::vector<Eigen::Vector3d>;

const geometry::TriangleMesh kTetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

Vertices moved(const Vertices& vertices, const Eigen::Vector3d& scale) {
  Vertices result;
  for (const Eigen::Vector3d& vertex : vertices) result.push_back(scale.cwiseProduct(vertex));
  return result;
}

BodyView::Worn worn(const std::string& scan_id, const Eigen::Vector3d& scale) {
  return {scan_id, "B1", moved(kTetrahedron.vertices, scale), {1, 0.9, 1.1, 1}};
}

std::string code_of(BodyView& view, const BodyView::Worn& worn) {
  try {
    view.take_worn(worn);
    return "";
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
}

TEST(BodyView, WithoutAGarmentEverythingIsNeutral) {
  BodyView view;
  view.take_body("one", kTetrahedron);
  EXPECT_EQ(view.vertices(1), kTetrahedron.vertices);
  for (const ColourBy by : {ColourBy::distortion, ColourBy::stretch, ColourBy::displacement, ColourBy::plain})
    for (const Colour& colour : colours_of(auto_scale(by, view.values(by, 1)), view.values(by, 1)))
      EXPECT_EQ(colour, kNeutral);
}

TEST(BodyView, NeverMixesTwoScans) {
  BodyView view;
  view.take_body("one", kTetrahedron);
  view.take_worn(worn("two", {2, 2, 2}));  // its mesh is still to come
  EXPECT_FALSE(view.is_worn());
  EXPECT_NE(view.note(), "");
  EXPECT_EQ(view.vertices(1), kTetrahedron.vertices);
  view.take_body("two", kTetrahedron);
  EXPECT_TRUE(view.is_worn());
  EXPECT_EQ(view.note(), "");
  view.take_body("three", kTetrahedron);
  EXPECT_FALSE(view.is_worn());
}

TEST(BodyView, ForgetsOneScanAndNoOther) {
  BodyView view;
  view.take_body("one", kTetrahedron);
  view.take_worn(worn("one", {2, 1, 1}));
  view.take_worn(worn("two", {2, 2, 2}));  // waits
  EXPECT_FALSE(view.forget("three"));
  EXPECT_TRUE(view.is_worn());
  const int revision = view.revision();
  EXPECT_TRUE(view.forget("one"));
  EXPECT_TRUE(view.empty());
  EXPECT_FALSE(view.is_worn());
  EXPECT_EQ(view.scan_id(), "");
  EXPECT_TRUE(view.mesh().vertices.empty());
  EXPECT_NE(view.revision(), revision);
  EXPECT_FALSE(view.forget("one"));
  EXPECT_TRUE(view.forget("two"));
  view.take_body("two", kTetrahedron);
  EXPECT_FALSE(view.is_worn());  // what waited for it is gone
}

TEST(BodyView, RefusesWhatDoesNotFitAndKeepsWhatWasThere) {
  BodyView view;
  view.take_body("one", kTetrahedron);
  view.take_worn(worn("one", {2, 1, 1}));
  const Vertices good = view.vertices(1);

  BodyView::Worn bad = worn("one", {3, 3, 3});
  bad.vertices.pop_back();
  EXPECT_EQ(code_of(view, bad), geometry::refusal::kBadMesh);
  bad = worn("one", {3, 3, 3});
  bad.distortion.push_back(1);
  EXPECT_EQ(code_of(view, bad), geometry::refusal::kBadMesh);
  bad = worn("one", {3, 3, 3});
  bad.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of(view, bad), geometry::refusal::kNonFinite);
  bad = worn("one", {3, 3, 3});
  bad.distortion[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code_of(view, bad), geometry::refusal::kNonFinite);
  EXPECT_THROW(view.take_body("four", {kTetrahedron.vertices, {{0, 1, 9}}}), geometry::Refusal);
  EXPECT_THROW(view.take_body("four", {}), geometry::Refusal);

  EXPECT_EQ(view.scan_id(), "one");
  EXPECT_EQ(view.vertices(1), good);
}

TEST(BodyView, ABadWornBodyThatWaitedDoesNotHoldUpItsMesh) {
  BodyView view;
  BodyView::Worn bad = worn("one", {1, 1, 1});
  bad.vertices.pop_back();
  view.take_worn(bad);
  view.take_body("one", kTetrahedron);
  EXPECT_EQ(view.scan_id(), "one");
  EXPECT_FALSE(view.is_worn());
  EXPECT_NE(view.note().find("3 vertices"), std::string::npos);
  view.take_worn(worn("one", {2, 1, 1}));
  EXPECT_EQ(view.note(), "");
}

TEST(BodyView, WhatIsWornOverTheSameScanStays) {
  BodyView view;
  view.take_body("one", kTetrahedron);
  view.take_worn(worn("one", {2, 1, 1}));
  const int revision = view.revision();
  view.take_body("one", kTetrahedron);  // a latched message comes again
  EXPECT_TRUE(view.is_worn());
  EXPECT_NE(view.revision(), revision);
  geometry::TriangleMesh smaller = kTetrahedron;
  smaller.vertices.pop_back();
  smaller.triangles = {{0, 2, 1}};
  view.take_body("one", smaller);
  EXPECT_FALSE(view.is_worn());
  EXPECT_NE(view.note(), "");
  view.take_body("two", kTetrahedron);
  EXPECT_EQ(view.note(), "");
}

TEST(BodyView, BlendsFromRestToWorn) {
  BodyView view;
  view.take_body("one", kTetrahedron);
  view.take_worn(worn("one", {3, 1, 1}));
  EXPECT_EQ(view.vertices(0), kTetrahedron.vertices);
  EXPECT_EQ(view.vertices(0.5), moved(kTetrahedron.vertices, {2, 1, 1}));
  EXPECT_DOUBLE_EQ(view.values(ColourBy::distortion, 0.5)[1], 0.95);
  EXPECT_EQ(view.values(ColourBy::displacement, 1), (std::vector<double>{0, 2, 0, 0}));
}

TEST(SkinStretch, FindsThePrincipalStretchFartherFromOne) {
  // A flat square pulled to 1.2 one way and pressed to 0.9 the other: 1.2 * 0.9 > 1, so 1.2 counts.
  const geometry::TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const SkinStretch stretch(square);
  for (const double s : stretch.at(square.vertices)) EXPECT_EQ(s, 1);
  for (const double s : stretch.at(moved(square.vertices, {1.2, 0.9, 1}))) EXPECT_NEAR(s, 1.2, 1e-12);
  for (const double s : stretch.at(moved(square.vertices, {0.7, 1.1, 1}))) EXPECT_NEAR(s, 0.7, 1e-12);
}

TEST(ColourScale, AutomaticReachesTheFarthestValueAndKeepsNeutral) {
  const ColourScale scale = auto_scale(ColourBy::distortion, {1, 0.95, 1.02});
  EXPECT_DOUBLE_EQ(scale.low, 0.95);
  EXPECT_DOUBLE_EQ(scale.high, 1.05);
  EXPECT_EQ(colour_of(scale, 1), kNeutral);
  EXPECT_EQ(colour_of(scale, 0.95), distortion_colour(kTightest));
  EXPECT_EQ(colour_of(fixed_scale(ColourBy::distortion), 0.85), distortion_colour(0.85));
  EXPECT_EQ(auto_scale(ColourBy::distortion, {2.5}).low, 0);  // no area is less
}

}  // namespace
}  // namespace tensegric_fit::inspect
