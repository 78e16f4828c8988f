/// Bra sizes of EN 13402-3.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "inspect/bra_size.hpp"

namespace tensegric_fit::inspect {
namespace {

std::string label(double bust_cm, double underbust_cm) {
  const auto size = bra_size(bust_cm / 100, underbust_cm / 100);
  return size ? size->label() : "none";
}

TEST(BraSizeTest, ExamplesOfTheStandardsTables) {
  EXPECT_EQ(label(107, 87), "85D");
  EXPECT_EQ(label(108, 89), "90D");
  EXPECT_EQ(label(100, 82), "80C");
}

TEST(BraSizeTest, TwelveToFourteenIsOverTwelveUpToFourteen) {
  EXPECT_EQ(label(85.1, 75), "75AA");
  EXPECT_EQ(label(87, 75), "75AA");
  EXPECT_EQ(label(87.1, 75), "75A");
  EXPECT_EQ(label(89, 75), "75A");
  EXPECT_EQ(label(89.1, 75), "75B");
  EXPECT_EQ(label(103, 75), "75H");
  EXPECT_EQ(label(139, 75), "75Z");
}

TEST(BraSizeTest, BandsAreTheNearestMultipleOfFive) {
  EXPECT_EQ(label(87.4, 72.4), "70B");
  EXPECT_EQ(label(87.5, 72.5), "75B");
  EXPECT_EQ(label(92.4, 77.4), "75B");
}

TEST(BraSizeTest, DecimalGirthsAreNotPushedOverALimitByBinaryOnes) {
  for (int millimetres = 580; millimetres < 1400; ++millimetres) {
    const auto size = bra_size(millimetres / 1000.0 + 0.14, millimetres / 1000.0);
    ASSERT_TRUE(size) << millimetres;
    EXPECT_EQ(size->cup, "A") << millimetres;  // 14 cm is the end of A
  }
}

std::string labels(double bust_cm, double underbust_cm, double half_width_cm) {
  std::string text;
  for (const BraSize& size : bra_sizes({"bust", bust_cm / 100, 1, "", half_width_cm / 100},
                                       {"underbust", underbust_cm / 100, 1, "", half_width_cm / 100}))
    text += (text.empty() ? "" : " ") + size.label();
  return text;
}

TEST(BraSizeTest, OnABorderASecondSizeIsNamed) {
  EXPECT_EQ(labels(90, 75, 0), "75B");    // exact
  EXPECT_EQ(labels(90, 75, 0.5), "75B");  // the middle of B
  EXPECT_EQ(labels(90.8, 75, 0.5), "75B 75C");
  EXPECT_EQ(labels(91.2, 75, 0.5), "75C 75B");
  EXPECT_EQ(labels(92.5, 77.5, 0.5), "80B 75B");  // bands; whoever has the smaller one has no other cup
  EXPECT_EQ(labels(85, 75, 0.5), "");             // none as measured
}

TEST(BraSizeTest, GirthsThatAreUnsureHaveNone) {
  const geometry::Measure sure{"bust", 0.9, 0.5, "", 0.01}, unsure{"underbust", 0.75, 0.49, "", 0.01};
  EXPECT_TRUE(bra_sizes(sure, unsure).empty());
  EXPECT_TRUE(bra_sizes({"bust", 0.9, 0.49, "", 0.01}, {"underbust", 0.75, 0.5, "", 0.01}).empty());
  EXPECT_FALSE(bra_sizes(sure, {"underbust", 0.75, 0.5, "", 0.01}).empty());
}

TEST(BraSizeTest, ASecondSizeIsAsLikelyAsItsDefinitionSays) {
  // 0.674 deviations from a border a quarter of all lie beyond it. Bust alone is uncertain.
  const auto sizes = [](double off) {
    return bra_sizes({"bust", 0.91 - off, 1, "", 0.01}, {"underbust", 0.75, 1, "", 0}).size();
  };
  const double deviation = 0.01 / 1.96;
  EXPECT_EQ(sizes(0.62 * deviation), 2u);
  EXPECT_EQ(sizes(0.73 * deviation), 1u);
}

TEST(BraSizeTest, TheLikeliestOtherIsNamedWhereMostOfTheSharesAreOthers) {
  EXPECT_EQ(labels(90.3, 75, 4), "75B 75C");  // each of them less often than one time in four
}

TEST(BraSizeTest, GirthsThatNoSizeIsMadeForHaveNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(label(85, 75), "none");
  EXPECT_EQ(label(75, 85), "none");
  EXPECT_EQ(label(139.1, 75), "none");
  EXPECT_EQ(label(72, 57), "none");
  EXPECT_EQ(label(170, 143), "none");
  EXPECT_EQ(label(nan, 75), "none");
  EXPECT_EQ(label(90, nan), "none");
  EXPECT_EQ(label(std::numeric_limits<double>::infinity(), 75), "none");
}

}  // namespace
}  // namespace tensegric_fit::inspect
