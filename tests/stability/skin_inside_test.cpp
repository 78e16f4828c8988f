#include "skin_inside.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/crossing_triangles.hpp"

namespace tensegric_fit::stability {
namespace {

using Eigen::Vector3d;

// A closed ball of bands of triangles, counter-clockwise from outside.
geometry::TriangleMesh ball(const Vector3d& centre, double radius) {
  constexpr int kRound = 40, kUp = 20;
  geometry::TriangleMesh mesh;
  mesh.vertices.push_back(centre - radius * Vector3d::UnitZ());
  for (int i = 1; i < kUp; ++i)
    for (int k = 0; k < kRound; ++k) {
      const double up = M_PI * (static_cast<double>(i) / kUp - 0.5), round = 2 * M_PI * (k + 0.3) / kRound;
      mesh.vertices.push_back(centre + radius * Vector3d(std::cos(up) * std::cos(round),
                                                         std::cos(up) * std::sin(round), std::sin(up)));
    }
  mesh.vertices.push_back(centre + radius * Vector3d::UnitZ());
  const int top = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [](int i, int k) { return 1 + (i - 1) * kRound + k % kRound; };
  for (int k = 0; k < kRound; ++k) {
    mesh.triangles.emplace_back(0, at(1, k + 1), at(1, k));
    mesh.triangles.emplace_back(top, at(kUp - 1, k), at(kUp - 1, k + 1));
    for (int i = 1; i + 1 < kUp; ++i) {
      mesh.triangles.emplace_back(at(i, k), at(i, k + 1), at(i + 1, k + 1));
      mesh.triangles.emplace_back(at(i, k), at(i + 1, k + 1), at(i + 1, k));
    }
  }
  return mesh;
}

geometry::TriangleMesh two_balls(double apart) {
  geometry::TriangleMesh mesh = ball(Vector3d(0.1, 0.2, -0.1), 0.05);
  const geometry::TriangleMesh other = ball(Vector3d(0.1 + apart, 0.2, -0.1), 0.05);
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& t : other.triangles)
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
  return mesh;
}

std::vector<std::pair<int, int>> all_pairs(const geometry::TriangleMesh& mesh) {
  return geometry::crossing_pairs(mesh.vertices, mesh.triangles, std::vector<char>(mesh.vertices.size(), 1));
}

TEST(SkinInside, IsTheLensOfTwoBalls) {
  const geometry::TriangleMesh mesh = two_balls(0.09);
  const auto patches = skin_inside(mesh, all_pairs(mesh));
  ASSERT_EQ(patches.size(), 2u);
  for (const SkinInside& patch : patches) {
    double deepest = 0;
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
      deepest = std::max(deepest, patch.depths[i]);
      // Behind the other ball's skin, to within what flat triangles lie inside it.
      const bool first = patch.vertices[i] < static_cast<int>(mesh.vertices.size()) / 2;
      const Vector3d centre(first ? 0.19 : 0.1, 0.2, -0.1);
      EXPECT_LT((mesh.vertices[patch.vertices[i]] - centre).norm(), 0.05);
    }
    EXPECT_NEAR(deepest, 0.010, 0.001);
  }
  EXPECT_TRUE(skin_inside(two_balls(0.1001), all_pairs(two_balls(0.1001))).empty());
}

}  // namespace
}  // namespace tensegric_fit::stability
