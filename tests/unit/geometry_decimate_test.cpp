#include <gtest/gtest.h>

#include <cmath>

#include "geometry/decimate.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

// Ring of radius 1 m, tube of radius 0.3 m.
TriangleMesh torus(int around, int across, double x = 0) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int k = 0; k < across; ++k) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * k / across, ring = 1 + 0.3 * std::cos(v);
      mesh.vertices.emplace_back(x + ring * std::cos(u), ring * std::sin(u), 0.3 * std::sin(v));
      const int right = (i + 1) % around, up = (k + 1) % across;
      mesh.triangles.emplace_back(across * i + k, across * right + k, across * right + up);
      mesh.triangles.emplace_back(across * i + k, across * right + up, across * i + up);
    }
  return mesh;
}

TEST(Decimate, ATorusKeepsItsHole) {
  const TriangleMesh fine = torus(120, 60);
  for (int triangles : {200, 1001}) {
    const TriangleMesh mesh = with_triangles(fine, triangles);
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), triangles, 1);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangles.size());  // V - E + F = 0
    // 200 facets of some 0.35 m lie inside the tube by about a seventh of its radius.
    EXPECT_NEAR(cone_volume(mesh.vertices, mesh.triangles) / (2 * M_PI * M_PI * 0.09), 1, 0.2);
  }
}

TEST(Decimate, ShortEdgesGoAndTheTorusStaysAsItIs) {
  const TriangleMesh fine = torus(120, 60);  // sides of 0.02 to 0.07 m
  const TriangleMesh mesh = without_short_edges(fine, 0.035);
  EXPECT_LT(mesh.triangles.size(), 2 * fine.triangles.size() / 3);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangles.size());  // V - E + F = 0
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    const Vector3d ring = Vector3d(middle.x(), middle.y(), 0).normalized();
    const Vector3d twice = area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    EXPECT_GT(twice.dot(middle - ring), 0) << "turned over";
  }
  // Vertices stay on the torus; facets of 0.1 m lie 4 mm inside its tube of 0.3 m, 3 % of the section's area.
  EXPECT_NEAR(cone_volume(mesh.vertices, mesh.triangles) / (2 * M_PI * M_PI * 0.09), 1, 0.03);
  EXPECT_EQ(without_short_edges(fine, 0.001).triangles.size(), fine.triangles.size());
}

TEST(Decimate, PiecesStayApart) {
  TriangleMesh two = torus(60, 30);
  const TriangleMesh other = torus(60, 30, 5);
  const int count = static_cast<int>(two.vertices.size());
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& t : other.triangles)
    two.triangles.push_back(t + Eigen::Vector3i::Constant(count));
  const TriangleMesh mesh = with_triangles(two, 400);
  EXPECT_TRUE(is_closed(mesh));
  const std::vector<int> piece = components_of(mesh);
  EXPECT_EQ(*std::max_element(piece.begin(), piece.end()), 1);
  EXPECT_EQ(2 * mesh.vertices.size(), mesh.triangles.size());  // two holes
}

TEST(Decimate, SheetsThatMeetInAVertexAreRefused) {
  const TriangleMesh bow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  const TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                         {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_NO_THROW(with_triangles(bow, 4));  // OpenMesh holds two borders in one vertex
  try {
    with_triangles(fan, 4);
    FAIL() << "three sheets in one edge";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "bad_mesh");
  }
}

TEST(Decimate, ABeltIsMadeFinerAndNothingElse) {
  const TriangleMesh coarse = torus(60, 30);
  const int wanted = static_cast<int>(coarse.triangles.size()) + 1000;
  const TriangleMesh fine = with_finer_belt(coarse, wanted, -0.1, 0.1);
  EXPECT_NEAR(static_cast<double>(fine.triangles.size()), wanted, 1);
  EXPECT_TRUE(is_closed(fine));
  for (std::size_t v = coarse.vertices.size(); v < fine.vertices.size(); ++v)
    EXPECT_LE(std::abs(fine.vertices[v].z()), 0.1);
  EXPECT_TRUE(std::equal(coarse.vertices.begin(), coarse.vertices.end(), fine.vertices.begin()));
  EXPECT_EQ(with_finer_belt(coarse, wanted, 5, 6).triangles, coarse.triangles) << "nothing is there";
}

}  // namespace
}  // namespace tensegric_fit::geometry
