/// The nearest point of a surface against a look at every triangle.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "geometry/nearest_on_sides.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

constexpr unsigned kSeed = 5;

/// Triangles anywhere in a cube of 1 m, from 1 mm to 1 m long, needles among them.
TriangleMesh triangles_of_all_sizes(std::mt19937& random) {
  std::uniform_real_distribution<double> place(0, 1), direction(-1, 1), exponent(-3, 0);
  TriangleMesh mesh;
  for (int i = 0; i < 600; ++i) {
    const Vector3d corner(place(random), place(random), place(random));
    const double size = std::pow(10, exponent(random));
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    mesh.vertices.push_back(corner);
    mesh.vertices.push_back(corner +
                            size * Vector3d(direction(random), direction(random), direction(random)));
    mesh.vertices.push_back(corner +
                            0.1 * size * Vector3d(direction(random), direction(random), direction(random)));
  }
  return mesh;
}

/// Distance from `query` to a triangle, by trying its points on a fine grid: at most 2 % of the size too far.
double distance_by_grid(const std::array<Vector3d, 3>& corners, const Vector3d& query) {
  constexpr int kSteps = 100;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) {
      const double a = static_cast<double>(i) / kSteps, b = static_cast<double>(j) / kSteps;
      least = std::min(least, (a * corners[0] + b * corners[1] + (1 - a - b) * corners[2] - query).norm());
    }
  return least;
}

TEST(SurfaceTreeTest, FindsTheNearestOfTrianglesOfAllSizes) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  const TriangleMesh mesh = triangles_of_all_sizes(random);
  const SurfaceTree tree(mesh);
  std::uniform_real_distribution<double> place(-0.5, 1.5);
  for (int i = 0; i < 40; ++i) {
    const Vector3d query(place(random), place(random), place(random));
    const SurfacePoint nearest = tree.nearest(query);
    const double distance = (nearest.position - query).norm();
    EXPECT_NEAR(nearest.barycentric.sum(), 1, 1e-12);
    EXPECT_GE(nearest.barycentric.minCoeff(), 0);
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const std::array<Vector3d, 3> corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
      const Vector3d centre = (corners[0] + corners[1] + corners[2]) / 3;
      double reach = 0;
      for (const Vector3d& c : corners) reach = std::max(reach, (c - centre).norm());
      if ((centre - query).norm() - reach > distance) continue;  // too far away whatever its shape
      EXPECT_LE(distance, distance_by_grid(corners, query) + 1e-12);
    }
  }
}

TEST(SurfaceTreeTest, SeesALargeTriangleBehindManySmallOnes) {
  TriangleMesh mesh;
  mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}};  // its centroid is the origin
  mesh.triangles.emplace_back(0, 1, 2);
  for (int i = 0; i < 50; ++i) {  // all have their centroids nearer to the query than the large one
    const Vector3d corner(0.8 + 0.001 * i, -0.9, 0.01);
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(),
                         {corner, corner + Vector3d(0.001, 0, 0), corner + Vector3d(0, 0.001, 0)});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  const SurfacePoint nearest = SurfaceTree(mesh).nearest({0.8, -0.9, 0.001});
  EXPECT_EQ(nearest.triangle, 0);
  EXPECT_NEAR((nearest.position - Vector3d(0.8, -0.9, 0)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace tensegric_fit::geometry
