// Lines in even steps, their first harmonics, outlines; pieces of a mesh and the skin over a point.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/even_steps.hpp"
#include "geometry/oriented_tree.hpp"
#include "geometry/section.hpp"
#include "geometry/triangle_mesh.hpp"

namespace {

using namespace tensegric_fit::geometry;
using Eigen::Vector3d;

std::vector<Vector3d> circle(double radius, int count) {
  std::vector<Vector3d> loop;
  for (int i = 0; i < count; ++i)
    loop.emplace_back(radius * std::cos(2 * M_PI * i / count), radius * std::sin(2 * M_PI * i / count), 0.3);
  return loop;
}

/// A strip of squares over x from 0 to 1, two triangles each, at height z.
TriangleMesh strip(double z, int squares) {
  TriangleMesh mesh;
  for (int i = 0; i <= squares; ++i)
    for (const double y : {0.0, 1.0}) mesh.vertices.emplace_back(double(i) / squares, y, z);
  for (int i = 0; i < squares; ++i) {
    mesh.triangles.emplace_back(2 * i, 2 * i + 2, 2 * i + 1);
    mesh.triangles.emplace_back(2 * i + 1, 2 * i + 2, 2 * i + 3);
  }
  return mesh;
}

TEST(EvenSteps, AreEvenAlongTheLineAndEndInTime) {
  const std::vector<Vector3d> corner{{0, 0, 0}, {0.010, 0, 0}, {0.010, 0.010, 0}};
  const std::vector<Vector3d> even = even_steps(corner, 0.003, 0.020);
  ASSERT_EQ(even.size(), 7u);  // 0 to 18 mm
  EXPECT_EQ(even.front(), corner.front());
  EXPECT_LT((even[3] - Vector3d(0.009, 0, 0)).norm(), 1e-12);
  EXPECT_LT((even[4] - Vector3d(0.010, 0.002, 0)).norm(), 1e-12);  // round the corner
  EXPECT_EQ(even_steps(corner, 0.003, 0.005).size(), 4u);  // to the end of the segment where 5 mm are reached
}

TEST(FirstHarmonics, LeaveACircleAndTakeNoiseOffItsTape) {
  const double radius = 0.06;
  const std::vector<Vector3d> smooth = first_harmonics(circle(radius, 400), 8, 180);
  for (const Vector3d& p : smooth) EXPECT_NEAR(p.head<2>().norm(), radius, 1e-4);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.0005);
  std::vector<Vector3d> rough = circle(radius, 400);
  for (Vector3d& p : rough) p.head<2>() *= 1 + noise(random) / radius;
  const double true_girth = 2 * M_PI * radius,
               raw = length_of(tape(rough, Vector3d::UnitZ()), true) - true_girth,
               taken_off =
                   length_of(tape(first_harmonics(rough, 8, 180), Vector3d::UnitZ()), true) - true_girth;
  EXPECT_GT(raw, 0.003);  // the tape lies on the outermost points: some 1.5 deviations out, times 2 pi
  EXPECT_LT(std::abs(taken_off), raw / 4);
}

TEST(Outline, RunsRoundTheInsideAndAHollowDoesNot) {
  SectionLoop loop{circle(0.1, 30), {}, true};
  EXPECT_TRUE(is_outline(loop, Vector3d::UnitZ()));
  EXPECT_FALSE(is_outline(loop, -Vector3d::UnitZ()));
  loop.closed = false;
  loop.points.resize(20);  // a third of it is missing
  EXPECT_TRUE(is_outline(loop, Vector3d::UnitZ()));
  EXPECT_FALSE(is_outline(loop, -Vector3d::UnitZ()));
}

TEST(Submesh, OfNumberedTrianglesIsThatOfFlaggedOnes) {
  const TriangleMesh whole = strip(0, 10);
  std::vector<char> keep(whole.triangles.size(), 0);
  const std::vector<int> numbers{3, 4, 11};
  for (const int t : numbers) keep[t] = 1;
  const TriangleMesh few = submesh(whole, numbers), flagged = submesh(whole, keep);
  EXPECT_EQ(few.vertices, flagged.vertices);
  EXPECT_EQ(few.triangles, flagged.triangles);
}

TEST(HighestNear, IsTheUppermostSheetWithinReach) {
  TriangleMesh sheets = strip(0.1, 4);
  for (const double z : {0.2, 0.5}) {
    const int first = static_cast<int>(sheets.vertices.size());
    const TriangleMesh more = strip(z, 4);
    sheets.vertices.insert(sheets.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const Eigen::Vector3i& t : more.triangles) sheets.triangles.push_back(t.array() + first);
  }
  const Vector3d point(0.3, 0.4, 0.15);
  ASSERT_TRUE(highest_near(sheets, point, 0.1, 0.1));
  EXPECT_NEAR(highest_near(sheets, point, 0.1, 0.1)->z(), 0.2, 1e-12);
  EXPECT_NEAR(highest_near(sheets, point, 0.1, 0.01)->z(), 0.1, 1e-12);
  EXPECT_FALSE(highest_near(sheets, point, 0.01, 0.01));
  EXPECT_FALSE(highest_near(sheets, {1.5, 0.4, 0.15}, 1, 1));
}

/// Once without end: a step of no length.
TEST(FirstHarmonics, OfALoopWithoutLengthAreItsPlace) {
  const Vector3d place(1, 2, 3);
  EXPECT_EQ(first_harmonics({place, place, place}, 8, 180), std::vector<Vector3d>(180, place));
}

/// At 1000 km single precision knows places to 0.06 m.
TEST(OrientedTree, FarFromTheOriginPlacesAreKeptApart) {
  const Vector3d far(1e6, -1e6, 0);
  std::vector<Vector3d> points;
  for (int i = 0; i < 100; ++i) points.push_back(far + Vector3d(0.001 * i, 0, 0));
  const OrientedTree tree(points, std::vector<Vector3d>(points.size(), Vector3d::UnitZ()));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(tree.nearest(points[i], Vector3d::UnitZ()), i);
}

TEST(OrientedTree, ANearerPointThatFacesAwayIsFartherThanOneThatFacesAlike) {
  const OrientedTree tree({{0, 0, 0}, {0.03, 0, 0}}, {-Vector3d::UnitX(), Vector3d::UnitX()});
  EXPECT_EQ(tree.nearest({0.01, 0, 0}, Vector3d::UnitX()), 1);
  EXPECT_EQ(tree.nearest({0.01, 0, 0}, -Vector3d::UnitX()), 0);
  EXPECT_NEAR(tree.distance({0.01, 0, 0}, Vector3d::UnitX()), 0.02, 1e-6);
}

}  // namespace
