// What is measured where a scan shows skin twice is doubted, and nothing else.
#include "geometry/fracture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace tensegric_fit::geometry {
namespace {

TEST(Fractures, DoubtWhatTheyTouch) {
  BodyMeasures measures;
  measures.landmarks = {{"axilla_L", {0.15, 0, 1.25}, 0.9, "", 0.009},
                        {"axilla_R", {-0.15, 0, 1.25}, 0.3, "hidden", 0.03}};
  measures.girths = {{"bust", 0.95, 0.9, "", 0.005}, {"hip", 1.0, 0.9, "", 0.005}};
  measures.loops = {{"bust", {{0.1, -0.1, 1.2}, {0.16, 0.01, 1.22}}}, {"hip", {{0.15, 0, 0.9}}}};
  doubt_fractured({{{0.16, 0, 1.22}, 0.05, 0.004, 0.012}}, measures);
  EXPECT_LT(measures.landmarks[0].confidence, 0.5);
  EXPECT_NE(measures.landmarks[0].reason.find("12 mm"), std::string::npos);
  EXPECT_NEAR(measures.landmarks[0].half_width, 0.015, 1e-12);  // 9 and 12 mm
  EXPECT_EQ(measures.landmarks[1].confidence, 0.3);
  EXPECT_EQ(measures.landmarks[1].half_width, 0.03);
  EXPECT_EQ(measures.landmarks[1].reason, "hidden");
  EXPECT_LT(measures.girths[0].confidence, 0.5);
  EXPECT_NEAR(measures.girths[0].half_width, 0.013, 1e-12);
  EXPECT_EQ(measures.girths[1].confidence, 0.9);
  EXPECT_EQ(measures.girths[1].half_width, 0.005);
  EXPECT_TRUE(measures.girths[1].reason.empty());
}

TEST(Fractures, DoubtHeightsThatAreReadThere) {
  const std::vector<Landmark> landmarks{
      {"bust_point_L", {0.2, 0.1, 1.2}, 0.9, ""},   {"bust_point_R", {0.2, -0.1, 1.2}, 0.9, ""},
      {"underbust_L", {0.15, 0.1, 1.1}, 0.9, ""},   {"underbust_R", {0.15, -0.1, 1.1}, 0.9, ""},
      {"buttock_L", {-0.1, 0.1, 0.85}, 0.9, ""},    {"buttock_R", {-0.1, -0.1, 0.85}, 0.9, ""},
      {"neck_front", {0.06, 0.0, 1.4}, 0.9, ""},    {"crotch", {0.02, 0.0, 0.75}, 0.9, ""},
      {"waist_side_L", {0.02, 0.14, 1.0}, 0.9, ""}, {"shoulder_L", {0.0, 0.18, 1.35}, 0.9, ""}};
  const std::pair<Eigen::Vector3d, std::string> cases[] = {
      {{0.2, 0.11, 1.2}, "bust"},   {{0.2, -0.11, 1.2}, "bust"},   {{0.15, -0.1, 1.11}, "underbust"},
      {{-0.1, 0.1, 0.86}, "hip"},   {{0.02, 0.0, 0.74}, "crotch"}, {{0.06, 0.0, 1.41}, "neck"},
      {{0.15, 0.01, 1.0}, "waist"}, {{0.0, 0.18, 1.35}, ""}};
  for (const auto& [place, doubted] : cases) {
    BodyMeasures measures;
    measures.landmarks = landmarks;
    for (const char* name : {"bust", "underbust", "waist", "hip", "crotch", "neck", "stature"})
      measures.heights.push_back({name, 1.0, 0.9, "", 0.003});
    measures.loops.push_back({"waist", {{0.15, 0.0, 1.0}, {0.02, 0.14, 1.0}, {-0.1, 0.0, 1.0}}});
    doubt_fractured({Fracture{place, 0.03, 0.004, 0.004}}, measures);
    for (const Measure& height : measures.heights) {
      EXPECT_EQ(height.confidence < 0.5, height.name == doubted) << height.name << ", not " << doubted;
      EXPECT_EQ(height.reason.empty(), height.name != doubted) << height.name;
      EXPECT_NEAR(height.half_width, height.name == doubted ? 0.005 : 0.003, 1e-12) << height.name;
    }
  }
}

TEST(Fractures, OfTwoTheWiderOneCounts) {
  const Fracture narrow{{0, 0, 1}, 0.05, 0.008, 0.004}, wide{{0.01, 0, 1}, 0.05, 0.004, 0.012};
  for (const std::vector<Fracture>& fractures : {std::vector<Fracture>{narrow, wide}, {wide, narrow}}) {
    BodyMeasures measures;
    measures.landmarks = {{"navel", {0, 0, 1}, 0.9, "", 0.005}};
    doubt_fractured(fractures, measures);
    EXPECT_NEAR(measures.landmarks[0].half_width, 0.013, 1e-12);
    EXPECT_NE(measures.landmarks[0].reason.find("12 mm"), std::string::npos);
    EXPECT_EQ(measures.landmarks[0].reason.find("4 mm"), std::string::npos);
  }
}

TEST(Fractures, NeverRaiseAConfidence) {
  BodyMeasures measures;
  measures.landmarks = {{"crotch", {0, 0, 0.8}, 0.1, "a proportion"}};
  doubt_fractured({{{0, 0, 0.8}, 0.05, 0.004, 0.006}}, measures);
  EXPECT_EQ(measures.landmarks[0].confidence, 0.1);
  EXPECT_EQ(measures.landmarks[0].half_width, 0) << "unknown, as before";
  EXPECT_EQ(measures.landmarks[0].reason.find("a proportion"), 0u);
}

}  // namespace
}  // namespace tensegric_fit::geometry
