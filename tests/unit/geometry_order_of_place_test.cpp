/// The order of a surface's triangles that is its own.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "geometry/order_of_place.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

/// A leaning tube, thicker in front; `lopsided`: and on one side.
TriangleMesh tube(bool lopsided) {
  constexpr int kAround = 40, kLevels = 60;
  TriangleMesh mesh;
  for (int level = 0; level < kLevels; ++level)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * M_PI * i / kAround;
      const double radius = 0.15 + 0.03 * std::cos(angle) + (lopsided ? 0.02 * std::sin(angle + 1) : 0);
      mesh.vertices.emplace_back(1.4 * radius * std::cos(angle) + 0.1 * level / kLevels,
                                 radius * std::sin(angle), 0.01 * level);
      if (level == 0) continue;
      const int here = level * kAround + i, next = level * kAround + (i + 1) % kAround;
      mesh.triangles.emplace_back(here - kAround, next - kAround, next);
      mesh.triangles.emplace_back(here - kAround, next, here);
    }
  return mesh;
}

using Corners = std::vector<std::array<int, 3>>;

Corners corners_of(const std::vector<Eigen::Vector3i>& triangles) {
  Corners corners;
  for (const Eigen::Vector3i& t : triangles) corners.push_back({t[0], t[1], t[2]});
  return corners;
}

double share_in_place(const Corners& one, const Corners& other) {
  int same = 0;
  for (std::size_t i = 0; i < one.size(); ++i) same += one[i] == other[i] ? 1 : 0;
  return same / static_cast<double>(one.size());
}

TEST(OrderOfPlace, IsThatOfTheSurfaceWhateverTheFileHas) {
  for (const bool lopsided : {true, false}) {
    TriangleMesh mesh = tube(lopsided);
    const Corners before = corners_of(in_order_of_place(mesh));
    ASSERT_EQ(before.size(), mesh.triangles.size());
    std::mt19937 random(3);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    for (std::size_t f = 0; f < mesh.triangles.size(); f += 3) {
      const Eigen::Vector3i t = mesh.triangles[f];
      mesh.triangles[f] = {t[1], t[2], t[0]};
    }
    // Rounding of sums may put a triangle on the border of a cell into the next one.
    EXPECT_GT(share_in_place(corners_of(in_order_of_place(mesh)), before), 0.98) << lopsided;
  }
}

TEST(OrderOfPlace, TurnsWithTheSurface) {
  TriangleMesh mesh = tube(true);
  const Corners before = corners_of(in_order_of_place(mesh));
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(2, -1, 0.5) * Eigen::AngleAxisd(1.6, Vector3d(1, 2, 3).normalized());
  for (Vector3d& p : mesh.vertices) p = 1000 * (motion * p);  // and has another unit
  EXPECT_GT(share_in_place(corners_of(in_order_of_place(mesh)), before), 0.95);
}

TEST(OrderOfPlace, NeighboursFollowEachOtherAndRunAsTheyDid) {
  const TriangleMesh mesh = tube(true);
  const std::vector<Eigen::Vector3i> order = in_order_of_place(mesh);
  double steps = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    steps += (mesh.vertices[order[i][0]] - mesh.vertices[order[i - 1][0]]).norm();
  EXPECT_LT(steps / static_cast<double>(order.size()), 0.05);  // m; of any two triangles 0.3
  for (const Eigen::Vector3i& t : order) {
    const Vector3d middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    const Vector3d outward(middle.x() - 0.1 * middle.z() / 0.6, middle.y(), 0);
    EXPECT_GT(area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).dot(outward), 0);
  }
}

TEST(OrderOfPlace, OfNothingIsNothing) {
  EXPECT_TRUE(in_order_of_place({}).empty());
}

}  // namespace
}  // namespace tensegric_fit::geometry
