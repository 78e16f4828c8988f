// What is measured where a scan shows skin twice is doubted, and nothing else.
#include "geometry/fracture.hpp"

#include <gtest/gtest.h>

namespace tensegric_fit::geometry {
namespace {

TEST(Fractures, DoubtWhatTheyTouch) {
  BodyMeasures measures;
  measures.landmarks = {{"axilla_L", {0.15, 0, 1.25}, 0.9, ""},
                        {"axilla_R", {-0.15, 0, 1.25}, 0.3, "hidden"}};
  measures.girths = {{"bust", 0.95, 0.9, ""}, {"hip", 1.0, 0.9, ""}};
  measures.loops = {{"bust", {{0.1, -0.1, 1.2}, {0.16, 0.01, 1.22}}}, {"hip", {{0.15, 0, 0.9}}}};
  doubt_fractured({{{0.16, 0, 1.22}, 0.05, 0.004, 0.012}}, measures);
  EXPECT_LT(measures.landmarks[0].confidence, 0.5);
  EXPECT_NE(measures.landmarks[0].reason.find("12 mm"), std::string::npos);
  EXPECT_EQ(measures.landmarks[1].confidence, 0.3);
  EXPECT_EQ(measures.landmarks[1].reason, "hidden");
  EXPECT_LT(measures.girths[0].confidence, 0.5);
  EXPECT_EQ(measures.girths[1].confidence, 0.9);
  EXPECT_TRUE(measures.girths[1].reason.empty());
}

TEST(Fractures, NeverRaiseAConfidence) {
  BodyMeasures measures;
  measures.landmarks = {{"crotch", {0, 0, 0.8}, 0.1, "a proportion"}};
  doubt_fractured({{{0, 0, 0.8}, 0.05, 0.004, 0.006}}, measures);
  EXPECT_EQ(measures.landmarks[0].confidence, 0.1);
  EXPECT_EQ(measures.landmarks[0].reason.find("a proportion"), 0u);
}

}  // namespace
}  // namespace tensegric_fit::geometry
