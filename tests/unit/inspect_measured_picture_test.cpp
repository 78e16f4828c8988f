#include "inspect/measured_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "inspect/labels.hpp"
#include "inspect/picture.hpp"

namespace tensegric_fit::inspect {
namespace {

/// A plate that faces her front, 0.4 m to each side.
geometry::TriangleMesh plate() {
  return {{{0, -0.4, -0.4}, {0, 0.4, -0.4}, {0, 0.4, 0.4}, {0, -0.4, 0.4}}, {{0, 1, 2}, {0, 2, 3}}};
}

geometry::BodyMeasures with_landmark(const Eigen::Vector3d& position) {
  geometry::BodyMeasures measures;
  measures.landmarks.push_back({"navel", position, 1, ""});
  return measures;
}

/// Pixels of a strong colour, those of names and marks: skin, leaders and paper are nearly grey.
int coloured(const cv::Mat& picture) {
  int count = 0;
  for (const cv::Vec3b& pixel : cv::Mat3b(picture))
    count += std::max({pixel[0], pixel[1], pixel[2]}) - std::min({pixel[0], pixel[1], pixel[2]}) > 60;
  return count;
}

/// Pixels that are not alike in two pictures of one size.
int changed(const cv::Mat& one, const cv::Mat& other) {
  int count = 0;
  for (int row = 0; row < one.rows; ++row)
    for (int column = 0; column < one.cols; ++column)
      count += one.at<cv::Vec3b>(row, column) != other.at<cv::Vec3b>(row, column);
  return count;
}

cv::Mat middle_of(const cv::Mat& picture) {
  return picture(cv::Rect(picture.cols / 2 - 10, picture.rows / 2 - 10, 20, 20));
}

TEST(MeasuredPicture, WhatIsSeenIsADotWhatIsCloseBehindARingAndWhatIsFarBehindIsNotDrawn) {
  const cv::Mat on = front_picture(plate(), with_landmark({0, 0, 0}), 300),
                close = front_picture(plate(), with_landmark({-0.05, 0, 0}), 300),
                far = front_picture(plate(), with_landmark({-0.3, 0, 0}), 300);
  EXPECT_GT(coloured(middle_of(on)), 1.5 * coloured(middle_of(close)));  // a disc of 4 pixels, or its rim
  EXPECT_GT(coloured(middle_of(close)), 10);
  EXPECT_GT(coloured(on), coloured(middle_of(on)) + 40);  // its name
  EXPECT_EQ(coloured(far), 0);
}

TEST(MeasuredPicture, ATapeIsNamedWithItsLength) {
  geometry::BodyMeasures measures;
  measures.loops.push_back({"waist", {{0.001, -0.4, 0}, {0.001, 0.4, 0}, {-0.3, 0.4, 0}, {-0.3, -0.4, 0}}});
  const int name_alone = coloured(front_picture(plate(), measures, 300));
  measures.girths.push_back({"waist", 0.755, 1, ""});
  EXPECT_GT(coloured(front_picture(plate(), measures, 300)), name_alone + 40);
}

TEST(MeasuredPicture, TheBodyModelIsDrawnInTheColoursOfItsPartsWhereItFacesTheViewer) {
  const ModelSkin skin{plate().vertices, {{0, 1, 2, 3}}, {0, 0, 0, 0}, {"trunk"}};
  const std::vector<unsigned char> known(4, 0), unknown(4, 255);
  const ModelOverlay tinted{skin, known}, lines_alone{skin, unknown};
  const cv::Mat with_lines = front_picture(plate(), {}, 300, &lines_alone);
  const int none = coloured(front_picture(plate(), {}, 300)), lines = coloured(with_lines);
  EXPECT_EQ(none, 0);
  EXPECT_GT(lines, 200);
  // The tint is faint, but the plate has it all over.
  EXPECT_GT(changed(with_lines, front_picture(plate(), {}, 300, &tinted)), 20 * lines);
  const ModelSkin turned{plate().vertices, {{3, 2, 1, 0}}, {0, 0, 0, 0}, {"trunk"}};
  const ModelOverlay from_behind{turned, unknown};
  EXPECT_EQ(coloured(front_picture(plate(), {}, 300, &from_behind)), 0);
}

TEST(PartColours, PairsAreShadesOfOneColourAndNeighboursDiffer) {
  const std::vector<Colour> colours = part_colours({"trunk", "breast_L", "breast_R", "thigh_L", "thigh_R"});
  ASSERT_EQ(colours.size(), 5u);
  for (const int pair : {1, 3})
    for (int c = 0; c < 3; ++c) EXPECT_GT(colours[pair + 1][c], colours[pair][c]);
  EXPECT_NE(colours[0], colours[1]);
  EXPECT_NE(colours[1], colours[3]);
}

TEST(MeasuredPicture, ItIsAsHighAsAskedForAndShowsABodyWithoutMeasures) {
  const cv::Mat picture = side_picture({{{0, 0, 0}, {0.3, 0, 0}, {0.3, 0, 1.7}}, {{0, 1, 2}}}, {}, 400);
  EXPECT_EQ(picture.rows, 400);
  EXPECT_EQ(coloured(picture), 0);
}

TEST(Labels, NoTwoNamesTouch) {
  for (const double height : {0.0, 100.0, 250.0, 399.0}) {
    std::vector<Label> labels;
    for (int i = 0; i < 20; ++i) labels.push_back({"nnn", {190, height}, {0, 0, 200}, Label::Mark::none});
    const cv::Mat3b picture = with_labels(cv::Mat(400, 200, CV_8UC3, cv::Scalar(255, 255, 255)), labels);
    int names = 0;
    bool ink_above = false;
    for (int y = 0; y < picture.rows; ++y) {
      const bool ink = coloured(picture.row(y)) != 0;
      names += ink && !ink_above;
      ink_above = ink;
    }
    EXPECT_EQ(names, 20) << height;
  }
}

TEST(SeenPoints, SayWhereAndHowFarBehind) {
  const View view = front_view(Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(), 1);
  const auto seen =
      seen_points(plate(), {{0.2, 0.1, 0.2}, {-0.2, 0, 0}, {-0.2, 0, 0.45}, {0, 9, 0}}, view, 200, 200);
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_LT((seen[0].pixel - Eigen::Vector2d(120, 60)).norm(), 1e-9);
  EXPECT_NEAR(seen[0].behind, -0.2, 1e-6);  // depths are float
  EXPECT_NEAR(seen[1].behind, 0.2, 1e-6);
  EXPECT_EQ(seen[2].behind, 0);  // beside the body
  EXPECT_EQ(seen[3].behind, 0);  // beside the picture
}

}  // namespace
}  // namespace tensegric_fit::inspect
