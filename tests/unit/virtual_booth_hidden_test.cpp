#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/point_tree.hpp"
#include "virtual_booth/hidden_figures.hpp"

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

TEST(HiddenFiguresTest, SkinWithoutBonesShowsNoAcromion) {
  for (const char* name : {"point shoulder_L", "point shoulder_R"})
    EXPECT_EQ(std::count(heavy().doubts.vague.begin(), heavy().doubts.vague.end(), name), 1) << name;
}

}  // namespace
