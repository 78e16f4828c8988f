/// What is left of a mesh beyond a plane.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cut_off.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::geometry {
namespace {

const auto kAll = [](const std::vector<int>&) { return true; };

/// Two unit spheres, centres at x = -2 and x = 2.
TriangleMesh two_spheres() {
  TriangleMesh both = tffd::sphere(1, 40);
  const int count = static_cast<int>(both.vertices.size());
  const std::vector<Eigen::Vector3i> triangles = both.triangles;
  for (int v = 0; v < count; ++v) both.vertices.push_back(both.vertices[v] + 2 * Eigen::Vector3d::UnitX());
  for (int v = 0; v < count; ++v) both.vertices[v] -= 2 * Eigen::Vector3d::UnitX();
  for (const Eigen::Vector3i& t : triangles) both.triangles.emplace_back(t.array() + count);
  return both;
}

TEST(CutOff, ASphereWithoutItsCapIsClosedAndHasItsVolume) {
  const TriangleMesh sphere = tffd::sphere(1, 80);
  for (const double height : {-0.9, -0.3, 0.0123, 0.5, 0.97}) {
    const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, 1).normalized();
    const CutMesh cut = cut_off(sphere, {normal, -height}, kAll);
    const TriangleMesh left{cut.of(sphere.vertices), cut.triangles};
    EXPECT_TRUE(is_closed(left)) << height;
    const double cap = 1 - height, volume = 4 * M_PI / 3 - M_PI * cap * cap * (3 - cap) / 3;
    EXPECT_NEAR(cone_volume(left.vertices, left.triangles), volume, 0.01) << height;
    for (const Eigen::Vector3d& vertex : left.vertices) EXPECT_LT(vertex.dot(normal), height + 1e-12);
    for (std::size_t v = 0; v < sphere.vertices.size(); ++v)
      if (cut.left[v] >= 0) {
        EXPECT_EQ(left.vertices[cut.left[v]], sphere.vertices[v]);
      }
  }
}

TEST(CutOff, OnlyPiecesThatAreMeantGo) {
  const TriangleMesh both = two_spheres();
  const auto right = [&](const std::vector<int>& piece) { return both.vertices[piece.front()].x() > 0; };
  const CutMesh cut = cut_off(both, {Eigen::Vector3d::UnitZ(), -0.5}, right);
  double left_top = -1, right_top = -1;
  for (const Eigen::Vector3d& v : cut.of(both.vertices)) {
    double& top = v.x() < 0 ? left_top : right_top;
    top = std::max(top, v.z());
  }
  EXPECT_DOUBLE_EQ(left_top, 1);
  EXPECT_NEAR(right_top, 0.5, 1e-12);
}

TEST(CutOff, WhereNothingGoesEverythingStays) {
  const TriangleMesh sphere = tffd::sphere(1, 20);
  const CutMesh cut = cut_off(sphere, {Eigen::Vector3d::UnitZ(), -2}, kAll);
  EXPECT_EQ(cut.of(sphere.vertices), sphere.vertices);
  EXPECT_EQ(cut.triangles, sphere.triangles);
}

}  // namespace
}  // namespace tensegric_fit::geometry
