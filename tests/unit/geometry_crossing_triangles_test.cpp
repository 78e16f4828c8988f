// Triangles through triangles: single pairs, and random ones against every pair asked singly.
#include "geometry/crossing_triangles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../peak_memory.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

constexpr unsigned kSeed = 20261126;

TEST(CrossingTriangles, AnEdgeHasToGoThroughTheInside) {
  const Corners flat{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const auto upright = [](double x, double low) {
    return Corners{Vector3d(x, 0.2, low), Vector3d(x, 0.3, low), Vector3d(x, 0.25, 1)};
  };
  const std::vector<Vector3d> through = passages(flat, upright(0.2, -1));
  ASSERT_EQ(through.size(), 2u);
  EXPECT_LT((through[0] - Vector3d(0.2, 0.275, 0)).norm() * (through[1] - Vector3d(0.2, 0.275, 0)).norm(),
            1e-12);
  EXPECT_EQ(passages(upright(0.2, -1), flat).size(), 2u);
  // It reaches 1 behind the flat one, which reaches 0.2 behind it, or 0.8 where it faces the other way.
  const Corners upright_one = upright(0.2, -1);
  EXPECT_NEAR(crossing_depth(flat, upright_one), 0.2, 1e-12);
  EXPECT_NEAR(crossing_depth({upright_one[1], upright_one[0], upright_one[2]}, flat), 0.8, 1e-12);
  EXPECT_NEAR(crossing_depth(upright(0.2, -0.1), flat), 0.1, 1e-12);
  EXPECT_TRUE(passages(flat, upright(0.2, 1e-9)).empty());  // above it
  EXPECT_TRUE(passages(flat, upright(0.9, -1)).empty());    // beside it
  EXPECT_TRUE(passages(flat, upright(0.2, 0)).empty());     // standing on it
  EXPECT_TRUE(passages(flat, flat).empty());                // in its plane
}

// Triangles of very different sizes, anywhere in a box, each with corners of its own.
struct Heap {
  std::vector<Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

Heap heap_of(int count, const Vector3d& box, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Heap heap;
  for (int i = 0; i < count; ++i) {
    const Vector3d middle = box.cwiseProduct(Vector3d(unit(random), unit(random), unit(random)));
    const double size = 0.3 * std::pow(10, unit(random) - 1);
    for (int k = 0; k < 3; ++k)
      heap.vertices.push_back(middle + size * Vector3d(unit(random), unit(random), unit(random)));
    heap.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return heap;
}

std::vector<std::pair<int, int>> asked_singly(const Heap& heap, const std::vector<char>& looked_at) {
  const auto corners = [&](int i) {
    return Corners{heap.vertices[3 * i], heap.vertices[3 * i + 1], heap.vertices[3 * i + 2]};
  };
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < static_cast<int>(heap.triangles.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(heap.triangles.size()); ++j)
      if ((looked_at[3 * i] || looked_at[3 * j]) && !passages(corners(i), corners(j)).empty())
        pairs.emplace_back(i, j);
  return pairs;
}

TEST(CrossingTriangles, AreTheSameAsWhenEachPairIsAsked) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  for (const Vector3d& box : {Vector3d(0.3, 0.3, 0.3), Vector3d(1, 0.1, 0.2), Vector3d(0.5, 0.5, 0)}) {
    const Heap heap = heap_of(400, box, random);
    std::vector<char> all(heap.vertices.size(), 1), some(heap.vertices.size());
    for (std::size_t v = 0; v < some.size(); v += 3) some[v] = random() % 5 == 0;
    const auto pairs = crossing_pairs(heap.vertices, heap.triangles, all);
    EXPECT_GT(pairs.size(), 50u);
    EXPECT_EQ(pairs, asked_singly(heap, all));
    const auto fewer = crossing_pairs(heap.vertices, heap.triangles, some);
    EXPECT_LT(fewer.size(), pairs.size());
    EXPECT_EQ(fewer, asked_singly(heap, some));
  }
}

TEST(CrossingTriangles, LargeOnesAmongSmallOnesDoNotFillTheMemory) {
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  constexpr int kSmall = 4000, kLarge = 100;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  const auto point = [&] { return Vector3d(unit(random), unit(random), unit(random)); };
  Heap heap, large;
  for (int i = 0; i < kSmall; ++i) {
    const Vector3d middle = point();
    for (int k = 0; k < 3; ++k) heap.vertices.push_back(middle + 0.001 * point());
  }
  for (int i = 0; i < kLarge; ++i) {  // from corner to corner
    const Vector3d low = 0.01 * point() - Vector3d::Constant(0.5),
                   high = 0.01 * point() + Vector3d::Constant(0.5);
    for (const Vector3d& p : {low, high, point()}) {
      heap.vertices.push_back(p);
      large.vertices.push_back(p);
    }
    large.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  for (int i = 0; i < kSmall + kLarge; ++i) heap.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  const std::vector<char> all(heap.vertices.size(), 1);
  const gauge::Growth growth;
  const auto pairs = crossing_pairs(heap.vertices, heap.triangles, all);
  EXPECT_LT(growth.mebibytes(), 50);  // each large one in all 19,683 cells: 105
  std::vector<std::pair<int, int>> of_large;
  for (const auto& [a, b] : pairs)
    if (a >= kSmall) of_large.emplace_back(a - kSmall, b - kSmall);
  EXPECT_GT(of_large.size(), 100u);
  EXPECT_EQ(of_large, asked_singly(large, std::vector<char>(large.vertices.size(), 1)));
}

TEST(CrossingTriangles, NeighboursDoNotCount) {
  // Two pairs of triangles in the same places, once with a common corner.
  const std::vector<Vector3d> vertices{{0, 0, 0},      {1, 0, 0},      {0, 1, 0},
                                       {0.2, 0.2, -1}, {0.2, 0.3, -1}, {0.2, 0.25, 1}};
  const std::vector<char> all(vertices.size(), 1);
  EXPECT_EQ(crossing_pairs(vertices, {{0, 1, 2}, {3, 4, 5}}, all).size(), 1u);
  EXPECT_TRUE(crossing_pairs(vertices, {{0, 1, 2}, {3, 4, 5}}, std::vector<char>(vertices.size())).empty());
  EXPECT_TRUE(crossing_pairs(vertices, {{0, 1, 2}, {3, 0, 5}}, all).empty());
  EXPECT_TRUE(crossing_pairs({}, {}, {}).empty());
}

}  // namespace
}  // namespace tensegric_fit::geometry
