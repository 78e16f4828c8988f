/// A control mesh that holds as much as the skin under it.
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace tensegric_fit::control_mesh
