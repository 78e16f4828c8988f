#include "inspect/colours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace tensegric_fit::inspect {
namespace {

cv::Vec3f lab(const Colour& colour) {
  cv::Mat3f pixel(1, 1, cv::Vec3f(colour[0], colour[1], colour[2]) / 255), result;
  cv::cvtColor(pixel, result, cv::COLOR_RGB2Lab);
  return result(0, 0);
}

TEST(DistortionScale, AnUndeformedBodyIsOneNeutralColour) {
  for (const Colour& colour : distortion_colours(std::vector<double>(1000, 1))) EXPECT_EQ(colour, kNeutral);
  EXPECT_EQ(distortion_colour(1 + 1e-9), kNeutral);
  EXPECT_EQ(distortion_colour(std::nan("")), kNeutral);
}

TEST(DistortionScale, TighterIsRedLooserIsBlue) {
  const Colour tight = distortion_colour(0.8), loose = distortion_colour(1.2);
  EXPECT_GT(tight[0], tight[2] + 40);
  EXPECT_GT(loose[2], loose[0] + 40);
}

TEST(DistortionScale, SaturatesAtItsEnds) {
  EXPECT_EQ(distortion_colour(0.2), distortion_colour(kTightest));
  EXPECT_EQ(distortion_colour(9), distortion_colour(kLoosest));
  EXPECT_EQ(distortion_colour(-std::numeric_limits<double>::infinity()), kNeutral);  // no number, no claim
  EXPECT_NE(distortion_colour(0.72), distortion_colour(kTightest));
}

TEST(DistortionScale, IsEvenToTheEye) {
  // Equal steps of distortion are equal steps in CIE Lab, as far as 8 bits a channel allow (about one unit).
  const auto step = [](double from, double to) {
    return cv::norm(lab(distortion_colour(from)) - lab(distortion_colour(to)));
  };
  for (const double side : {-1.0, 1.0}) {
    const double first = step(1, 1 + 0.05 * side);
    EXPECT_GT(first, 5);
    for (int i = 1; i < 6; ++i) EXPECT_NEAR(step(1 + 0.05 * i * side, 1 + 0.05 * (i + 1) * side), first, 1.5);
  }
  // Neither side looks heavier than the other.
  EXPECT_NEAR(lab(distortion_colour(kTightest))[0], lab(distortion_colour(kLoosest))[0], 3);
}

TEST(Lit, IsBrightestTowardsTheLightAndKeepsTheHue) {
  const geometry::TriangleMesh octahedron{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  const std::vector<Colour> colours(6, Colour{200, 100, 50});
  const std::vector<Colour> result = lit(octahedron, colours, {0, 0, -2});  // from above, of any length
  EXPECT_EQ(result[4], colours[4]);
  for (int side = 0; side < 4; ++side) {
    EXPECT_LT(result[side][0], result[4][0]);
    EXPECT_GT(result[side][0], result[5][0]);
    EXPECT_NEAR(result[side][0], 2 * result[side][1], 2);
  }
  EXPECT_GT(result[5][0], 0);  // nothing is black
}

TEST(Colours, SkinThatIsNotHeldIsGreenAndStillShowsWhatIsUnderIt) {
  const std::vector<Colour> skin{kNeutral, {178, 24, 43}, {178, 24, 43}};
  const std::vector<Colour> shown = with_unheld(skin, {1});
  EXPECT_EQ(shown[0], skin[0]);
  EXPECT_EQ(shown[2], skin[2]);
  EXPECT_GT(shown[1][1], skin[1][1]);
  EXPECT_NE(shown[1], kUnheldColour);
}

}  // namespace
}  // namespace tensegric_fit::inspect
