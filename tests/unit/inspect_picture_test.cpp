#include "inspect/picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "geometry/status.hpp"
#include "inspect/composition.hpp"
#include "inspect/fit_pictures.hpp"

namespace tensegric_fit::inspect {
namespace {

geometry::TriangleMesh sphere(const Eigen::Vector3d& centre, double radius) {
  constexpr int kBands = 48, kSectors = 96;
  geometry::TriangleMesh mesh;
  for (int b = 0; b <= kBands; ++b)
    for (int s = 0; s < kSectors; ++s) {
      const double polar = M_PI * b / kBands,
                   around = 2 * M_PI * (s + 0.5) / kSectors;  // mirror-symmetric in x and y
      mesh.vertices.push_back(centre + radius * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                                std::sin(polar) * std::sin(around),
                                                                std::cos(polar)));
    }
  const auto at = [](int b, int s) { return b * kSectors + s % kSectors; };
  for (int b = 0; b < kBands; ++b)
    for (int s = 0; s < kSectors; ++s) {
      mesh.triangles.emplace_back(at(b, s), at(b + 1, s), at(b + 1, s + 1));
      mesh.triangles.emplace_back(at(b, s), at(b + 1, s + 1), at(b, s + 1));
    }
  return mesh;
}

// A square across x, facing her front, `half` metres to either side.
geometry::TriangleMesh square(double x, double half) {
  return {{{x, -half, -half}, {x, half, -half}, {x, half, half}, {x, -half, half}}, {{0, 1, 2}, {0, 2, 3}}};
}

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& more) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles) mesh.triangles.push_back(t.array() + first);
}

View front() {
  return front_view(Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(), 1);
}

bool is_white(const cv::Vec3b& pixel) {
  return pixel == cv::Vec3b(255, 255, 255);
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

// The middle of the covered pixels, in columns and rows from the picture's middle.
Eigen::Vector2d middle_of(const cv::Mat3b& picture) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (!is_white(picture(y, x))) sum += Eigen::Vector2d(x, y), ++count;
  return sum / count - Eigen::Vector2d(picture.cols - 1, picture.rows - 1) / 2;
}

TEST(Picture, ASpheresSilhouetteHasItsArea) {
  const cv::Mat3b picture = draw(sphere(Eigen::Vector3d::Zero(), 0.4), {}, {}, front(), 300, 300);
  double covered = 0;
  for (const cv::Vec3b& pixel : picture) covered += !is_white(pixel);
  // A pixel counts when half of it or less is covered too: half a pixel more along the edge of 754 pixels.
  // Polygon: 0.1 % less.
  EXPECT_NEAR(covered, M_PI * 120 * 120 + 0.5 * 2 * M_PI * 120, 250);
}

TEST(Picture, TheNearerSurfaceHidesTheFarther) {
  const Colour red{220, 20, 20}, blue{20, 20, 220};
  for (const bool red_is_near : {true, false}) {
    geometry::TriangleMesh mesh = square(red_is_near ? 0.2 : -0.2, 0.2);
    append(mesh, square(0, 0.4));
    std::vector<Colour> colours(4, red);
    colours.insert(colours.end(), 4, blue);
    const cv::Mat3b picture = draw(mesh, colours, {}, front(), 100, 100);
    const cv::Vec3b middle = picture(50, 50), outside = picture(50, 20);
    EXPECT_EQ(middle[2] > middle[0], red_is_near);  // BGR
    EXPECT_GT(outside[0], outside[2]);
  }
}

TEST(Picture, ASymmetricBodyHasASymmetricPicture) {
  geometry::TriangleMesh mesh = sphere({0, 0, 0}, 0.3);
  append(mesh, sphere({0.1, 0.2, 0.1}, 0.15));
  append(mesh, sphere({0.1, -0.2, 0.1}, 0.15));
  const cv::Mat picture = draw(mesh, {}, {}, front(), 200, 200);
  cv::Mat mirrored, difference;
  cv::flip(picture, mirrored, 1);
  cv::absdiff(picture, mirrored, difference);
  // Diagonals of the meshes are not mirrored, so shading differs by rounding; edges where a pixel's centre
  // lies just on one.
  EXPECT_LT(cv::mean(difference)[0], 0.1);
}

TEST(Picture, IsDeterministic) {
  const geometry::TriangleMesh mesh = sphere({0.1, 0, 0}, 0.3);
  EXPECT_TRUE(same_bytes(draw(mesh, {}, {}, front(), 200, 200), draw(mesh, {}, {}, front(), 200, 200)));
}

TEST(Picture, ShowsReliefAndLightFromAbove) {
  const cv::Mat3b picture = draw(sphere(Eigen::Vector3d::Zero(), 0.4), {}, {}, front(), 200, 200);
  EXPECT_GT(picture(60, 100)[0], picture(140, 100)[0] + 20);
  EXPECT_GT(picture(100, 100)[0], picture(100, 25)[0] + 20);
}

TEST(Picture, LinesAreDrawnWhereTheyAreVisible) {
  const geometry::TriangleMesh ball = sphere(Eigen::Vector3d::Zero(), 0.4);
  const Colour green{0, 200, 0};
  const cv::Mat plain = draw(ball, {}, {}, front(), 200, 200);
  const auto line_at = [&](double x) { return Polyline{{{x, -0.2, 0}, {x, 0.2, 0}}, false, green}; };
  EXPECT_TRUE(same_bytes(draw(ball, {}, {line_at(-0.45)}, front(), 200, 200), plain));  // behind her
  const cv::Mat3b picture = draw(ball, {}, {line_at(0.45)}, front(), 200, 200);
  EXPECT_EQ(picture(100, 100), cv::Vec3b(0, 200, 0));
  EXPECT_EQ(picture(100, 65), cv::Vec3b(0, 200, 0));
  EXPECT_EQ(picture(120, 100), plain.at<cv::Vec3b>(120, 100));
}

TEST(View, FollowsTheBodysFrame) {
  // The scans of a booth in which people face -y: body x is -y there, body y (her left) is x.
  Eigen::Isometry3d body_from_scan = Eigen::Isometry3d::Identity();
  body_from_scan.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const auto ball_at = [&](const Eigen::Vector3d& in_body,
                           View (*view)(const Eigen::Isometry3d&, const Eigen::Vector3d&, double)) {
    const geometry::TriangleMesh ball = sphere(body_from_scan.inverse() * in_body, 0.05);
    return middle_of(draw(ball, {}, {}, view(body_from_scan, Eigen::Vector3d::Zero(), 1), 100, 100));
  };
  const double tolerance = 0.6;  // pixels
  EXPECT_LT((ball_at({0, 0.3, 0}, front_view) - Eigen::Vector2d(30, 0)).norm(),
            tolerance);  // her left is on the right
  EXPECT_LT((ball_at({0.3, 0, 0}, front_view) - Eigen::Vector2d(0, 0)).norm(), tolerance);
  EXPECT_LT((ball_at({0, 0, 0.3}, front_view) - Eigen::Vector2d(0, -30)).norm(), tolerance);  // up is up
  EXPECT_LT((ball_at({0.3, 0, 0}, side_view) - Eigen::Vector2d(-30, 0)).norm(),
            tolerance);  // she looks to the left
  EXPECT_GT(ball_at({0, 0.3, 0}, oblique_view).x(), 20);
  EXPECT_LT(ball_at({0.3, 0, 0}, oblique_view).x(), -10);
  EXPECT_LT(ball_at({0, 0.3, 0}, back_view).x(), -20);  // her left is on the left
  EXPECT_LT(ball_at({0, 0.3, 0}, oblique_back_view).x(), -20);
}

TEST(Picture, RefusesByName) {
  const geometry::TriangleMesh mesh = square(0, 0.3);
  EXPECT_THROW(draw(mesh, std::vector<Colour>(3), {}, front(), 10, 10), geometry::Refusal);
  EXPECT_THROW(draw(mesh, {}, {}, front(), 0, 10), geometry::Refusal);
  EXPECT_THROW(draw({{{0, 0, std::nan("")}}, {}}, {}, {}, front(), 10, 10), geometry::Refusal);
  EXPECT_TRUE(
      is_white(draw({}, {}, {}, front(), 10, 10).at<cv::Vec3b>(5, 5)));  // no mesh, no picture, no crash
}

TEST(FitPictures, AnUndeformedBodyLooksTheSameBeforeAndAfter) {
  const geometry::TriangleMesh body = sphere({0, 0, 1}, 0.3);
  const std::vector<double> ones(body.vertices.size(), 1);
  const geometry::BodyMeasures measures;
  const FitScene scene{body, body.vertices, ones, measures, {}, {}, {}};
  for (const cv::Mat& picture : {front_picture(scene), side_picture(scene), back_picture(scene)}) {
    ASSERT_EQ(picture.size(), cv::Size(1212, 637));
    const cv::Rect left(0, 37, 600, 600), right(612, 37, 600, 600);  // under the captions
    EXPECT_TRUE(same_bytes(picture(left), picture(right)));
    EXPECT_FALSE(is_white(picture.at<cv::Vec3b>(320, 300)));
  }
}

TEST(FitPictures, SkinThatFoldsIsMarked) {
  const geometry::TriangleMesh body = sphere({0, 0, 1}, 0.3);
  const std::vector<double> ones(body.vertices.size(), 1);
  const geometry::BodyMeasures measures;
  FitScene scene{body, body.vertices, ones, measures, {}, {}, {}};
  const cv::Mat plain = front_picture(scene), plain_distortion = distortion_picture(scene);
  for (std::size_t v = 0; v < body.vertices.size(); ++v)
    if (body.vertices[v].z() > 1.1) scene.warned.push_back(static_cast<int>(v));
  const cv::Mat marked = front_picture(scene);
  const cv::Rect left(0, 37, 600, 600), lower_right(612, 37 + 400, 600, 200);
  EXPECT_TRUE(same_bytes(plain(left), marked(left)));                // before there is nothing to mark
  EXPECT_TRUE(same_bytes(plain(lower_right), marked(lower_right)));  // nor where it does not fold
  EXPECT_FALSE(same_bytes(plain, marked));
  EXPECT_FALSE(same_bytes(plain_distortion, distortion_picture(scene)));
}

TEST(FitPictures, DistortionIsShownInColour) {
  const geometry::TriangleMesh body = sphere({0, 0, 1}, 0.3);
  const geometry::BodyMeasures measures;
  const auto middle_at = [&](double value) {
    const std::vector<double> distortion(body.vertices.size(), value);
    const cv::Mat picture = distortion_picture({body, body.vertices, distortion, measures, {}, {}, {}});
    EXPECT_EQ(picture.size(), cv::Size(1212, 715));
    return picture.at<cv::Vec3b>(336, 300);
  };
  EXPECT_GT(middle_at(0.7)[2], middle_at(0.7)[0] + 50);  // tighter: red
  EXPECT_GT(middle_at(1.3)[0], middle_at(1.3)[2] + 50);  // looser: blue
  EXPECT_LT(std::abs(middle_at(1)[0] - middle_at(1)[2]), 20);
}

TEST(FitPictures, TheWordsBesideTheScaleAreWhole) {
  for (const int rows : {637, 1249}) {  // one row of panels, two
    const cv::Mat picture = with_distortion_scale(cv::Mat(rows, 1212, CV_8UC3, cv::Scalar::all(255)));
    for (const int column : {0, 1, 2, picture.cols - 3, picture.cols - 2, picture.cols - 1})
      for (int y = 0; y < picture.rows; ++y)
        EXPECT_TRUE(is_white(picture.at<cv::Vec3b>(y, column))) << rows << " rows: " << column << ", " << y;
  }
}

// A name at the end of a long note must not be outside the picture.
TEST(WithNote, StandsUnderThePictureInAsManyLinesAsItNeeds) {
  const cv::Mat picture(320, 200, CV_8UC3, cv::Scalar(10, 20, 30));
  EXPECT_EQ(with_note(picture, "").rows, picture.rows);
  const cv::Mat one = with_note(picture, "Missing: crown"),
                more = with_note(
                    picture, "Missing: left forearm, right hand, left shank, right foot, top of the head");
  const int line = one.rows - picture.rows;
  EXPECT_GT(line, 0);
  const cv::Mat high(1327, 1212, CV_8UC3), low(637, 1212, CV_8UC3);
  EXPECT_EQ(with_note(high, "crown").rows - high.rows, with_note(low, "crown").rows - low.rows);
  EXPECT_GT(more.rows, one.rows);
  EXPECT_EQ((more.rows - picture.rows) % line, 0);
  EXPECT_EQ(cv::norm(one(cv::Rect(0, 0, 200, 320)), picture), 0) << "the picture itself stays";
  for (int y = picture.rows; y < more.rows; y += line) {
    cv::Mat inked;
    cv::inRange(more(cv::Rect(0, y, 200, line)), cv::Scalar(0, 0, 0), cv::Scalar(254, 200, 254), inked);
    EXPECT_GT(cv::countNonZero(inked), 20) << "line at " << y;
    EXPECT_EQ(cv::countNonZero(inked.col(0)) + cv::countNonZero(inked.col(199)), 0) << "cut off at " << y;
  }
}

}  // namespace
}  // namespace tensegric_fit::inspect
