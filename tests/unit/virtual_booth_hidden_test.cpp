#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/point_tree.hpp"
#include "virtual_booth/hidden_figures.hpp"
#include "virtual_booth/truth_file.hpp"

namespace {

using namespace tensegric_fit;
using virtual_body::BodyParameters;
using virtual_body::VirtualBody;
using virtual_booth::ScannerOptions;

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::count(names.begin(), names.end(), name) > 0;
}

ScannerOptions exact_booth(int columns) {
  ScannerOptions options;
  options.columns = columns;
  options.points = 1000000;
  options.noise = options.outliers = options.misregistration = 0;
  return options;
}

/// Thighs that touch, arms near the trunk.
const VirtualBody& heavy() {
  static const VirtualBody body = [] {
    BodyParameters parameters;
    parameters.build = 1.4;
    parameters.hip = 1.1;
    parameters.arm_angle = 0.6;
    parameters.yaw = 0.7;
    parameters.tilt = 0.05;
    return virtual_body::make_body(parameters);
  }();
  return body;
}

TEST(HiddenFiguresTest, NoPointOfAScanLiesNearAHiddenPlaceAndSomeNearEveryOther) {
  int hidden_places = 0, seen_places = 0;
  for (const int columns : {2, 4}) {
    const ScannerOptions booth = exact_booth(columns);
    const std::vector<std::string> hidden = virtual_booth::hidden_figures(heavy(), booth);
    const geometry::PointTree points(virtual_booth::scan_body(heavy().mesh, booth).cloud.points);
    for (const auto& [landmark, allowed] : {std::pair{"axilla_L", 0.010},
                                            {"axilla_R", 0.010},
                                            {"crotch", 0.010},
                                            {"bust_point_L", 0.005},
                                            {"bust_point_R", 0.005}}) {
      const double nearest = points.distance(heavy().truth.landmark(landmark));
      SCOPED_TRACE(std::string(landmark) + ", " + std::to_string(columns) + " columns, nearest point " +
                   std::to_string(nearest) + " m");
      constexpr double kSpacing = 0.002;  // m between the places asked for, and more than between points
      if (holds(hidden, std::string("point ") + landmark)) {
        ++hidden_places;
        EXPECT_GT(nearest, allowed - kSpacing);
      } else {
        ++seen_places;
        EXPECT_LT(nearest, allowed + kSpacing);
      }
    }
    for (const char* name : {"point crotch", "height crotch"}) EXPECT_TRUE(holds(hidden, name)) << name;
  }
  EXPECT_GE(hidden_places, 2);
  EXPECT_GE(seen_places, 4);
}

TEST(HiddenFiguresTest, WhatABoothCannotSeeJoinsTheBodysOwnDoubtsOnce) {
  const virtual_body::Doubts doubts = virtual_booth::doubts_in_booth(heavy(), exact_booth(4));
  EXPECT_EQ(doubts.vague, heavy().doubts.vague);
  for (const std::string& figure : heavy().doubts.hidden) EXPECT_TRUE(holds(doubts.hidden, figure)) << figure;
  for (const std::string& figure : doubts.hidden)
    EXPECT_EQ(std::count(doubts.hidden.begin(), doubts.hidden.end(), figure), 1) << figure;
}

TEST(HiddenFiguresTest, AShoulderThatNoRayMeetsIsHidden) {
  constexpr double kHalf = 0.2, kHeight = 1.7;  // of a block, whose top lies above all sensors
  VirtualBody block;
  for (int corner = 0; corner < 8; ++corner)
    block.mesh.vertices.emplace_back(corner & 1 ? kHalf : -kHalf, corner & 2 ? kHalf : -kHalf,
                                     corner & 4 ? kHeight : 0);
  block.mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                          {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  block.truth.landmarks = {{"shoulder_L", {0, 0, kHeight}, 1, ""}, {"shoulder_R", {0, -kHalf, 1.2}, 1, ""}};
  EXPECT_EQ(virtual_booth::hidden_figures(block, exact_booth(4)),
            std::vector<std::string>{"point shoulder_L"});
}

TEST(HiddenFiguresTest, ATruthFileTellsWhatTheBodyHidesFromWhatTheBoothCannotSee) {
  const auto path = std::filesystem::path(testing::TempDir()) / "hidden_figures_truth.json";
  virtual_booth::write_truth(path, heavy(), exact_booth(2));
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(path));
  std::filesystem::remove(path);
  const auto listed = [&truth](const char* key) { return truth.at(key).get<std::vector<std::string>>(); };
  EXPECT_EQ(listed("hidden"), virtual_booth::doubts_in_booth(heavy(), exact_booth(2)).hidden);
  EXPECT_EQ(listed("hidden_on_surface"), heavy().doubts.hidden);
}

TEST(HiddenFiguresTest, SkinWithoutBonesShowsNoAcromion) {
  for (const char* name : {"point shoulder_L", "point shoulder_R"})
    EXPECT_EQ(std::count(heavy().doubts.vague.begin(), heavy().doubts.vague.end(), name), 1) << name;
}

}  // namespace
