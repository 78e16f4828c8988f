/// Which triangles lie badly on the skin, and what is done about them.
#include <gtest/gtest.h>

#include <cmath>

#include "control_mesh/relax.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;

/// 0.4 m each way round the origin, facing +z.
geometry::TriangleMesh level_ground() {
  constexpr int kCells = 20;
  geometry::TriangleMesh mesh;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j) {
      mesh.vertices.emplace_back(0.04 * (i - kCells / 2), 0.04 * (j - kCells / 2), 0);
      const int here = i * (kCells + 1) + j;
      if (i == kCells || j == kCells) continue;
      mesh.triangles.emplace_back(here, here + kCells + 1, here + kCells + 2);
      mesh.triangles.emplace_back(here, here + kCells + 2, here + 1);
    }
  return mesh;
}

/// One triangle with its base of 0.1 m on the ground and corners of `degrees` there, lifted about it by
/// `tilt`.
geometry::ControlMesh one_triangle(double degrees, double tilt) {
  const double high = 0.05 * std::tan(degrees * M_PI / 180), lift = tilt * M_PI / 180;
  geometry::ControlMesh control;
  control.outer = {{0, 0, 0}, {0.1, 0, 0}, {0.05, high * std::cos(lift), high * std::sin(lift)}};
  control.triangles = {{0, 1, 2}};
  return control;
}

TEST(BadlyLaid, ATriangleMoreThan78DegreesOffTheSkinIsTurned) {
  const Skin skin(level_ground());
  for (double tilt : {0.0, 60.0, 77.0}) EXPECT_EQ(count_badly_laid(one_triangle(60, tilt), skin).turned, 0);
  for (double tilt : {80.0, 120.0, 180.0})
    EXPECT_EQ(count_badly_laid(one_triangle(60, tilt), skin).turned, 1);
}

TEST(BadlyLaid, ACornerUnder11DegreesIsSharp) {
  const Skin skin(level_ground());
  EXPECT_EQ(count_badly_laid(one_triangle(11, 0), skin).sharp, 1);
  EXPECT_EQ(count_badly_laid(one_triangle(12, 0), skin).sharp, 0);
  EXPECT_EQ(count_badly_laid(one_triangle(85, 0), skin).sharp, 1);  // 10 degrees at its tip
  EXPECT_TRUE(count_badly_laid(one_triangle(60, 0), skin).none());
}

/// A fan of four triangles round a node that lies outside of them.
TEST(TurnBack, ANodeThatTurnsItsTrianglesOverSlidesBack) {
  const Skin skin(level_ground());
  geometry::ControlMesh control;
  control.outer = {{0.25, 0, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}, {0.1, -0.1, 0}};
  control.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  ASSERT_EQ(count_badly_laid(control, skin).turned, 1);
  std::vector<Slide> slides(5, Slide::none);
  std::vector<GridNeighbours> around(5, {-1, -1, -1, -1});
  around[0] = {1, 3, 2, 4};  // its way leads across the fan
  turn_back(control, {slides, around}, skin);
  EXPECT_EQ(count_badly_laid(control, skin).turned, 1);  // it may not
  slides[0] = Slide::along_column;
  const std::vector<Vector3d> before = control.outer;
  turn_back(control, {slides, around}, skin);
  EXPECT_TRUE(count_badly_laid(control, skin).none());
  for (int corner = 1; corner < 5; ++corner) EXPECT_EQ(control.outer[corner], before[corner]);
  EXPECT_LT(std::abs(control.outer[0].x()), 0.1);
  EXPECT_NEAR(control.outer[0].z(), 0, 1e-12);
}

/// Two fans whose middles share a neighbour, one a little worse than the other: mended alike, and by no more
/// than both need.
TEST(TurnBack, TwoSidesThatAreNearlyAlikeMoveAlike) {
  const Skin skin(level_ground());
  for (const double worse : {1e-3, -1e-3}) {
    geometry::ControlMesh control;
    control.outer = {{0.05, 0, 0}, {0.1, 0.1, 0}, {0.3, 0.1, 0}, {0.3, -0.1, 0}, {0.1, -0.1, 0}};
    for (int v = 0; v < 5; ++v) {
      const Vector3d& p = control.outer[v];
      control.outer.emplace_back(-p.x() + (v == 0 ? worse : 0), p.y(), 0);
    }
    control.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4},
                         {5, 6, 7}, {5, 7, 8}, {5, 8, 9}, {5, 9, 6}};
    for (Eigen::Vector3i& t : control.triangles) std::swap(t[1], t[2]);
    if (count_badly_laid(control, skin).turned > 2)
      for (Eigen::Vector3i& t : control.triangles) std::swap(t[1], t[2]);
    ASSERT_EQ(count_badly_laid(control, skin).turned, 2);
    Slides slides{std::vector<Slide>(10, Slide::none), std::vector<GridNeighbours>(10, {-1, -1, -1, -1}), {}};
    slides.of[0] = slides.of[5] = Slide::along_column;
    slides.around[0] = {1, 3, 2, 4};
    slides.around[5] = {6, 8, 7, 9};
    slides.mirrored = {5, 6, 7, 8, 9, 0, 1, 2, 3, 4};
    turn_back(control, slides, skin);
    EXPECT_TRUE(count_badly_laid(control, skin).none());
    EXPECT_NEAR(control.outer[0].x(), -control.outer[5].x(), 1e-6);
    EXPECT_NEAR(control.outer[0].y(), control.outer[5].y(), 1e-6);
  }
}

}  // namespace
}  // namespace tensegric_fit::control_mesh
