/// A control mesh that holds as much as the skin under it.
#include <gtest/gtest.h>

#include <cmath>

#include "../peak_memory.hpp"
#include "control_mesh/match_skin.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;

constexpr double kHalf = 0.12, kRadius = 0.3;  // m; of a square part of a ball's top

geometry::TriangleMesh cap(int cells) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      const double x = kHalf * (2.0 * i / cells - 1), y = kHalf * (2.0 * j / cells - 1);
      mesh.vertices.emplace_back(x, y, std::sqrt(kRadius * kRadius - x * x - y * y));
      const int here = i * (cells + 1) + j;
      if (i == cells || j == cells) continue;
      mesh.triangles.emplace_back(here, here + cells + 1, here + cells + 2);
      mesh.triangles.emplace_back(here, here + cells + 2, here + 1);
    }
  return mesh;
}

/// Between the triangles and the plane z = 0, m^3.
double volume_under(const std::vector<Vector3d>& nodes, const std::vector<Eigen::Vector3i>& triangles) {
  double volume = 0;
  for (const Eigen::Vector3i& t : triangles)
    volume += geometry::area_vector(nodes[t[0]], nodes[t[1]], nodes[t[2]]).z() *
              (nodes[t[0]].z() + nodes[t[1]].z() + nodes[t[2]].z()) / 3;
  return volume;
}

struct MatchSkin : testing::Test {
  MatchSkin() {
    const geometry::TriangleMesh coarse = cap(kCells);
    control.outer = coarse.vertices;
    control.triangles = coarse.triangles;
    for (int i = 0; i <= kCells; ++i)
      for (int j = 0; j <= kCells; ++j) within.push_back(i > 0 && i < kCells && j > 0 && j < kCells);
  }
  double missing() const {
    return volume_under(fine.vertices, fine.triangles) - volume_under(control.outer, control.triangles);
  }

  static constexpr int kCells = 6;
  const geometry::TriangleMesh fine = cap(96);
  const Skin skin{fine};
  geometry::ControlMesh control;
  std::vector<char> within;  // of the rim
};

TEST_F(MatchSkin, ItHoldsAsMuchAsTheSkinAndKeepsWhatMayNotMove) {
  const std::vector<Vector3d> before = control.outer;
  const double cut_off = missing();
  ASSERT_GT(cut_off, 2e-5);  // 0.4 mm over it
  match_skin(control, within, skin);
  EXPECT_LT(std::abs(missing()), 0.05 * cut_off);  // beside the rim, which stays, nodes make up for it
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double moved = (control.outer[v] - before[v]).norm();
    EXPECT_LE(moved, 0.003 + 1e-12);
    if (within[v])
      EXPECT_GT(control.outer[v].dot(before[v]), before[v].squaredNorm());  // outward
    else
      EXPECT_EQ(moved, 0);
  }
}

// A mesh over level ground, some nodes of which lie farther off than they may move: the others make up for
// it, where the mesh holds too much as where it holds too little.
TEST_F(MatchSkin, WhatIsTooMuchIsEvenedOutAsWhatIsTooLittle) {
  geometry::TriangleMesh ground = fine;
  for (Vector3d& p : ground.vertices) p.z() = 0;
  const Skin level(ground);
  std::vector<Vector3d> ends[2];
  for (const double side : {1.0, -1.0}) {
    geometry::ControlMesh off = control;
    for (std::size_t v = 0; v < within.size(); ++v)
      off.outer[v].z() = within[v] && off.outer[v].x() < -0.02 ? side * 0.005 : 0;
    const double before = volume_under(off.outer, off.triangles);
    const std::vector<Vector3d> start = off.outer;
    match_skin(off, within, level);
    EXPECT_LT(std::abs(volume_under(off.outer, off.triangles)), 0.001 * std::abs(before)) << side;
    std::size_t held = 0;
    for (std::size_t v = 0; v < within.size(); ++v) held += (off.outer[v] - start[v]).norm() > 0.00299;
    EXPECT_GT(held, 4u);
    ends[side < 0] = off.outer;
  }
  for (std::size_t v = 0; v < within.size(); ++v)
    EXPECT_LT((ends[0][v] - ends[1][v].cwiseProduct(Vector3d(1, 1, -1))).norm(), 1e-12) << v;
}

TEST_F(MatchSkin, TheOrderOfTheNodesDoesNotMatter) {
  const std::size_t count = control.outer.size(), turn = count / 2;  // the middle one becomes the first
  geometry::ControlMesh other = control;
  std::vector<char> may_move = within;
  for (std::size_t v = 0; v < count; ++v) {
    other.outer[v] = control.outer[(v + turn) % count];
    may_move[v] = within[(v + turn) % count];
  }
  for (Eigen::Vector3i& t : other.triangles)
    for (int i = 0; i < 3; ++i) t[i] = static_cast<int>((t[i] + count - turn) % count);
  ASSERT_TRUE(may_move[0]);
  match_skin(control, within, skin);
  match_skin(other, may_move, skin);
  for (std::size_t v = 0; v < count; ++v)
    EXPECT_LT((other.outer[v] - control.outer[(v + turn) % count]).norm(), 1e-12) << v;
}

/// Slanted triangles of a metre, one over the other: the box of each is nearly all of the grid.
TEST(SkinGrid, LargeTrianglesDoNotFillTheMemory) {
  geometry::TriangleMesh sheets;
  for (int i = 0; i < 1000; ++i) {
    const double z = 1e-4 * i;
    sheets.vertices.emplace_back(0, 0, z);
    sheets.vertices.emplace_back(1, 0, z + 0.5);
    sheets.vertices.emplace_back(1, 1, z + 1);
    sheets.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  const gauge::Growth growth;
  const Skin skin(sheets);
  EXPECT_LT(growth.mebibytes(), 100);  // in cells of 20 mm: 500
  const auto lowest = skin.first_exit({0.6, 0.3, 0.1}, Vector3d::UnitZ(), 1);
  ASSERT_TRUE(lowest);
  EXPECT_NEAR(lowest->z(), 0.45, 1e-12);
  const auto highest = skin.nearest_along({0.6, 0.3, 0.6}, Vector3d::UnitZ(), 1);
  ASSERT_TRUE(highest);
  EXPECT_NEAR(highest->z(), 0.5499, 1e-12);
}

}  // namespace
}  // namespace tensegric_fit::control_mesh
