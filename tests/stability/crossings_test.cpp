#include "crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  for (const Eigen::Vector3i& t : other.triangles) mesh.triangles.push_back(t + Eigen::Vector3i::Constant(first));
  return mesh;
}

TEST(Crossings, OfTwoTriangles) {
  const std::array<Vector3d, 3> flat{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const auto upright = [](double x, double low) {
    return std::array<Vector3d, 3>{Vector3d(x, 0.2, low), Vector3d(x, 0.3, low), Vector3d(x, 0.25, 1)};
  };
  EXPECT_TRUE(cross(flat, upright(0.2, -1)));
  EXPECT_TRUE(cross(upright(0.2, -1), flat));
  EXPECT_FALSE(cross(flat, upright(0.2, 1e-6)));   // above it
  EXPECT_FALSE(cross(flat, upright(0.9, -1)));     // beside it
  EXPECT_FALSE(cross(flat, upright(0.2, 0)));      // standing on it
  EXPECT_FALSE(cross(flat, flat));                 // in its plane
}

TEST(Crossings, OfTwoBallsAreWhereTheyMeet) {
  const std::vector<char> all(two_balls(1).vertices.size(), 1);
  EXPECT_TRUE(crossings(two_balls(0.1001), all).empty());
  const geometry::TriangleMesh mesh = two_balls(0.09);
  const auto pairs = crossings(mesh, all);
  EXPECT_FALSE(pairs.empty());
  const int half = static_cast<int>(mesh.triangles.size()) / 2;
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, half);
    EXPECT_GE(b, half);
    // The circle in which spheres of 50 mm meet whose centres are 90 mm apart.
    const Vector3d place = (mesh.vertices[mesh.triangles[a][0]] + mesh.vertices[mesh.triangles[a][1]] +
                            mesh.vertices[mesh.triangles[a][2]]) /
                           3;
    EXPECT_NEAR(place.x(), 0.145, 0.006);
    EXPECT_NEAR((place - Vector3d(place.x(), 0.2, -0.1)).norm(), std::sqrt(0.05 * 0.05 - 0.045 * 0.045), 0.006);
  }
  // The same pairs from either ball, and none where neither has a vertex that is looked at.
  std::vector<char> one(all.size());
  std::fill(one.begin(), one.begin() + static_cast<long>(one.size() / 2), 1);
  EXPECT_EQ(crossings(mesh, one), pairs);
  EXPECT_TRUE(crossings(mesh, std::vector<char>(all.size())).empty());
}

TEST(Crossings, DepthIsThatOfTheLens) {
  const geometry::TriangleMesh mesh = two_balls(0.09);
  const auto patches = skin_inside(mesh, crossings(mesh, std::vector<char>(mesh.vertices.size(), 1)));
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
  EXPECT_TRUE(skin_inside(two_balls(0.2), {}).empty());
}

}  // namespace
}  // namespace tensegric_fit::stability
