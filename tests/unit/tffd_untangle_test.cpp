// Needles of a scanned mesh that a motion would turn over.
#include "tffd/untangle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;

/// A flat grid with a needle: vertex 12, in the middle, lies 10 micrometres off the side between 11 and 13's
/// neighbours.
geometry::TriangleMesh with_needle() {
  geometry::TriangleMesh mesh;
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c) mesh.vertices.emplace_back(0.01 * c, 0.01 * r, 0);
  add_grid(5, 5, 0, true, mesh.triangles);
  mesh.vertices[12].y() = 0.01 + 1e-5;  // just above the row below it
  return mesh;
}

std::vector<Anchor> all_of(const geometry::TriangleMesh& mesh) {
  std::vector<Anchor> anchors;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) anchors.push_back({static_cast<int>(v), 1});
  return anchors;
}

int turned(const geometry::TriangleMesh& mesh, const std::vector<Vector3d>& moved,
           const Eigen::Matrix3d& turn) {
  int count = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto facing = [&](const std::vector<Vector3d>& at) {
      return geometry::area_vector(at[t[0]], at[t[1]], at[t[2]]);
    };
    if (facing(moved).dot(turn * facing(mesh.vertices)) < 0) ++count;
  }
  return count;
}

TEST(Untangle, ANeedleThatTurnedOverIsTurnedBackAndNothingElseMoves) {
  const geometry::TriangleMesh mesh = with_needle();
  ASSERT_EQ(turned(mesh, mesh.vertices, Eigen::Matrix3d::Identity()), 0);
  std::vector<Vector3d> moved = mesh.vertices;
  for (Vector3d& p : moved) p += Vector3d(0.02, 0, 0.01);
  moved[12].y() -= 5e-5;  // through the opposite side
  const std::vector<Vector3d> before = moved;
  ASSERT_GT(turned(mesh, moved, Eigen::Matrix3d::Identity()), 0);
  Untangle(mesh, all_of(mesh))(mesh.vertices, moved);
  EXPECT_EQ(turned(mesh, moved, Eigen::Matrix3d::Identity()), 0);
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (v != 12) {
      EXPECT_EQ(moved[v], before[v]);
    }
  EXPECT_LT((moved[12] - before[12]).norm(), 1e-4);
}

TEST(Untangle, SkinThatIsTurnedRightRoundIsLeftAlone) {
  const geometry::TriangleMesh mesh = with_needle();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  std::vector<Vector3d> moved;
  for (const Vector3d& p : mesh.vertices) moved.push_back(turn * p);
  const std::vector<Vector3d> before = moved;
  Untangle(mesh, all_of(mesh))(mesh.vertices, moved);
  EXPECT_EQ(moved, before);
}

TEST(Untangle, AVertexThatIsNoAnchorStays) {
  const geometry::TriangleMesh mesh = with_needle();
  std::vector<Anchor> anchors = all_of(mesh);
  anchors.erase(anchors.begin() + 12);
  std::vector<Vector3d> moved = mesh.vertices;
  for (const int v : {6, 7, 8}) moved[v].y() += 5e-5;  // the row below it, over it
  const std::vector<Vector3d> before = moved;
  ASSERT_GT(turned(mesh, moved, Eigen::Matrix3d::Identity()), 0);
  Untangle(mesh, anchors)(mesh.vertices, moved);
  EXPECT_EQ(moved, before);
}

TEST(Untangle, NothingMovesAtRest) {
  const geometry::TriangleMesh mesh = with_needle();
  std::vector<Vector3d> moved = mesh.vertices;
  Untangle(mesh, all_of(mesh))(mesh.vertices, moved);
  EXPECT_EQ(moved, mesh.vertices);
}

}  // namespace
}  // namespace tensegric_fit::tffd
