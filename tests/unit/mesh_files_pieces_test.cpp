/// Triangles that run against the rest of their piece.
#include "mesh_files/pieces.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace tensegric_fit::mesh_files {
namespace {

using geometry::TriangleMesh;

// A hundredth of them turned, and axillae were 60 mm off: sections fell apart.
TEST(Pieces, TrianglesThatRunAgainstTheirPieceAreTurned) {
  TriangleMesh grid;
  constexpr int kSide = 12;
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) grid.vertices.emplace_back(i, j, 0);
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int a = j * (kSide + 1) + i, b = a + 1, c = a + kSide + 1, d = c + 1;
      grid.triangles.emplace_back(a, b, d);
      grid.triangles.emplace_back(a, d, c);
    }
  TriangleMesh turned = grid;
  for (std::size_t t = 0; t < turned.triangles.size(); t += 5)
    std::swap(turned.triangles[t][1], turned.triangles[t][2]);
  EXPECT_EQ(turned_alike(grid).triangles, grid.triangles);
  const TriangleMesh alike = turned_alike(turned);
  for (const Eigen::Vector3i& t : alike.triangles)
    EXPECT_GT(geometry::area_vector(grid.vertices[t[0]], grid.vertices[t[1]], grid.vertices[t[2]]).z(), 0);
  for (Eigen::Vector3i& t : turned.triangles) std::swap(t[1], t[2]);  // and inside out, which it stays
  for (const Eigen::Vector3i& t : turned_alike(turned).triangles)
    EXPECT_LT(geometry::area_vector(grid.vertices[t[0]], grid.vertices[t[1]], grid.vertices[t[2]]).z(), 0);

  TriangleMesh strip;  // of one side only
  constexpr int kRound = 10;
  for (int i = 0; i < kRound; ++i)
    for (const double across : {-1.0, 1.0}) strip.vertices.emplace_back(i, across, 0);
  for (int i = 0; i < kRound; ++i) {
    const bool last = i + 1 == kRound;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.emplace_back(a, b, c);
    strip.triangles.emplace_back(c, b, d);
  }
  EXPECT_EQ(turned_alike(strip).triangles, strip.triangles);
  // One twisted strip in a piece of many triangles: where it is cut would be by chance.
  TriangleMesh both = turned;
  const int first = static_cast<int>(both.vertices.size());
  both.vertices.insert(both.vertices.end(), strip.vertices.begin(), strip.vertices.end());
  for (const Eigen::Vector3i& t : strip.triangles)
    both.triangles.emplace_back(t[0] + first, t[1] + first, t[2] + first);
  const TriangleMesh mended = turned_alike(both);
  for (std::size_t t = 0; t < mended.triangles.size(); ++t) {
    if (t >= turned.triangles.size()) {
      EXPECT_EQ(mended.triangles[t], both.triangles[t]);
    } else {
      EXPECT_EQ(mended.triangles[t], turned_alike(turned).triangles[t]);
    }
  }
}

}  // namespace
}  // namespace tensegric_fit::mesh_files
