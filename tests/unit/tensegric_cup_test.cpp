// Cups on a symmetric bust: exact, even, on their own side.
#include <gtest/gtest.h>

#include "fit/bind_body.hpp"
#include "fit/chain.hpp"
#include "geometry/section.hpp"
#include "refusal_of.hpp"
#include "tensegric/course.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;
using Fibres = std::vector<std::vector<Vector3d>>;

/// The control mesh of 77 nodes with names below the breasts.
geometry::ControlMesh named_bust() {
  geometry::ControlMesh control = bust_mesh();
  for (const auto& [column, name] : {std::pair(1, "fold_inner"), {2, "fold"}, {3, "fold_outer"}}) {
    control.names[11 + 5 + column] = std::string(name) + "_L";
    control.names[11 + 5 - column] = std::string(name) + "_R";
  }
  return control;
}

GarmentLine cup(char side) {
  const std::string end = std::string("_") + side;
  GarmentLine line;
  line.name = "cup" + end;
  line.ratio = 0.9;
  line.through = {"bust_point" + end};
  line.fan = {"fold_outer" + end, "fold" + end, "fold_inner" + end};
  line.width = kBandWidth;
  line.smooth = kBandSmooth;
  return line;
}

double mean_length(const Fibres& fibres) {
  double length = 0;
  for (std::size_t f = 0; f < fibres.size(); ++f)
    length += geometry::length_of(fibres[f], false) / 6 * (f == 0 || f == 6 ? 0.5 : 1);
  return length;
}

struct Cups : testing::Test {
  fit::StageTimes times;
  const fit::Body body = [] {
    BustShape dense;
    dense.columns = 80;
    dense.rows = 48;
    const geometry::ControlMesh skin = bust_mesh(dense);
    return fit::take_mesh({skin.outer, skin.triangles});
  }();
  const fit::Fitting fitting = fit::prepare(body, named_bust(), {}, times);
  const Garment both{"cups", {"bust"}, {cup('L'), cup('R')}};

  fit::Fit wear(const Garment& garment) { return fit::wear(body, fitting, garment, {}, times); }
};

TEST_F(Cups, ComeToTheLengthThatIsAskedForAndAreMirrorImages) {
  const Solution worn = wear(both).solution;
  ASSERT_EQ(worn.status, Status::converged);
  const LineResult &left = worn.lines[0], &right = worn.lines[1];
  for (const LineResult* line : {&left, &right}) {
    EXPECT_TRUE(line->cup);
    EXPECT_NEAR(mean_length(line->fibres_at_rest), line->initial, 1e-9);
    EXPECT_NEAR(mean_length(line->fibres), 0.9 * mean_length(line->fibres_at_rest), 1e-6 * line->initial);
  }
  ASSERT_EQ(left.fibres.size(), 7u);
  for (std::size_t f = 0; f < 7; ++f)
    for (std::size_t i = 0; i < left.fibres[f].size(); ++i) {
      const Vector3d& other = right.fibres[6 - f][i];
      EXPECT_LT((left.fibres[f][i] - Vector3d(-other.x(), other.y(), other.z())).norm(), 1e-9);
    }
  EXPECT_NEAR(left.tension, right.tension, 1e-9 * left.tension);
  EXPECT_GT(left.tension, 0);
}

TEST_F(Cups, GiveTheSameBitsTwice) {
  const Solution one = wear(both).solution, other = wear(both).solution;
  EXPECT_EQ(one.outer, other.outer);
  EXPECT_EQ(one.lines[0].fibres, other.lines[0].fibres);
}

TEST_F(Cups, AreLaidAnewWhereOnlyTheirRowChanges) {
  const auto bound = fit::bind_body([this] { return body.mesh.mesh; }, fitting.control, {}, 0);
  const auto end_of = [&](const std::vector<std::string>& fan) -> Vector3d {
    Garment garment{"cups", {"bust"}, {cup('L')}};
    garment.lines[0].fan = fan;
    return bound->lay(garment).at(0).fibres.back().points.back().rest;
  };
  const auto at = [&](const char* name) { return fitting.control.outer[fitting.control.node(name)]; };
  EXPECT_LT((end_of({"fold_inner_L", "fold_L"}) - at("fold_L")).norm(), 1e-3);
  EXPECT_LT((end_of({"fold_inner_L", "fold_outer_L"}) - at("fold_outer_L")).norm(), 1e-3);
}

TEST_F(Cups, SpreadTheirPullOverTheBreast) {
  Garment strips = both;
  for (GarmentLine& line : strips.lines) {
    line.through.push_back(line.fan[1]);
    line.fan.clear();
  }
  const auto ends_apart = [](const LineResult& line) {
    return (line.fibres_at_rest.front().back() - line.fibres_at_rest.back().back()).norm();
  };
  const LineResult spread = wear(both).solution.lines[0], strip = wear(strips).solution.lines[0];
  EXPECT_NEAR(ends_apart(strip), 0.03, 0.002);
  const auto at = [&](const char* name) { return fitting.control.outer[fitting.control.node(name)]; };
  EXPECT_NEAR(ends_apart(spread), (at("fold_outer_L") - at("fold_inner_L")).norm(), 0.002);
}

TEST_F(Cups, OnTheWrongSideAreRefused) {
  const auto outcome = [&](const GarmentLine& line) {
    return refusal_of([&] { wear({"cups", {"bust"}, {line}}); });
  };
  EXPECT_EQ(outcome(cup('L')), "accepted");
  GarmentLine mirrored = cup('R');
  mirrored.name = "cup_L";
  EXPECT_EQ(outcome(mirrored), "bad_garment");
  GarmentLine crossed = cup('L');
  crossed.fan = cup('R').fan;
  EXPECT_EQ(outcome(crossed), "bad_garment");
  crossed.name = "cup";  // of no side: it begins on one and spreads on the other
  EXPECT_EQ(outcome(crossed), "bad_garment");
  GarmentLine half = cup('L');
  half.fan = {"fold_L", "fold_R"};
  EXPECT_EQ(outcome(half), "bad_garment");
  half.name = "front";  // from the middle or from both sides it may spread over both
  half.through = {"sternum"};
  EXPECT_EQ(outcome(half), "accepted");
}

TEST_F(Cups, RefuseNodesThatAreNotThereAndARowOverTheirOwnBeginning) {
  const auto outcome = [&](std::vector<std::string> fan) {
    GarmentLine line = cup('L');
    line.fan = std::move(fan);
    return refusal_of([&] { course_of(fitting.control, line); });
  };
  EXPECT_EQ(outcome({"fold_L", "fold_outer_L"}), "accepted");
  EXPECT_EQ(outcome({"fold_L", "elbow_L"}), "unknown_line");
  EXPECT_EQ(outcome({"fold_L", "fold_L"}), "bad_garment");
  EXPECT_EQ(outcome({"fold_L", "bust_point_L"}), "bad_garment");
}

TEST_F(Cups, AreHeldWhereTheirWholeRowIs) {
  geometry::ControlMesh control = fitting.control;
  control.names[6] = "rim_inner_L";
  control.names[7] = "rim_L";
  const auto held = [&](std::vector<std::string> fan) {
    GarmentLine line = cup('L');
    line.fan = std::move(fan);
    return course_of(control, line).held;
  };
  EXPECT_EQ(held({"rim_inner_L", "rim_L"}), (std::array<bool, 2>{false, true}));
  EXPECT_EQ(held({"rim_L", "fold_L"}), (std::array<bool, 2>{false, false}));
}

}  // namespace
}  // namespace tensegric_fit::tensegric
