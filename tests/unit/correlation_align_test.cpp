// Laying one surface onto another: a figure with a head, so that nothing of it slides or turns on itself.
#include <gtest/gtest.h>

#include <cmath>

#include "correlation/align.hpp"
#include "correlation_customer.hpp"

namespace tensegric_fit::correlation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::TriangleMesh;

// A closed surface of unit directions p at radius(p), finer than the millimetre that is asked of it.
template <typename Radius>
TriangleMesh star(const Radius& radius) {
  constexpr int kRings = 90, kSides = 120;
  TriangleMesh mesh;
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      const double u = M_PI * i / kRings, v = 2 * M_PI * j / kSides;
      const Vector3d p(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
      mesh.vertices.push_back(radius(p) * p);
    }
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      const int a = kSides * i + j, b = kSides * i + (j + 1) % kSides, c = a + kSides, d = b + kSides;
      if (i > 0) mesh.triangles.push_back({a, c, b});
      if (i + 1 < kRings) mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

// Mirror-symmetric in y, 0.5 m high; a bulge as large as a breast on each side of the front.
double figure(const Vector3d& p, double bust = 0) {
  const double trunk = 0.12 + 0.13 * p.z() * p.z() + 0.03 * p.y() * p.y() + 0.02 * p.x();
  const double bulge = std::exp(-30 * ((p - Vector3d(0.9, 0.35, 0.2)).squaredNorm())) +
                       std::exp(-30 * ((p - Vector3d(0.9, -0.35, 0.2)).squaredNorm()));
  return trunk + bust * bulge;
}

Patch patch_of(const TriangleMesh& mesh) {
  return {mesh.vertices, geometry::vertex_normals(mesh.vertices, mesh.triangles)};
}

Isometry3d motion(double degrees, const Vector3d& axis, const Vector3d& shift) {
  Isometry3d m = Isometry3d::Identity();
  m.linear() = Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()).toRotationMatrix();
  m.translation() = shift;
  return m;
}

const Isometry3d kStance = motion(9, {0.1, -0.2, 1}, {0.03, -0.02, 0.01});

void expect_same(const Isometry3d& a, const Isometry3d& b, double metres) {
  for (const Vector3d& p : {Vector3d(0.2, 0, 0), Vector3d(0, 0.2, 0.3), Vector3d(0, -0.2, -0.3)})
    EXPECT_LT((a * p - b * p).norm(), metres);
}

TEST(Align, FindsAKnownMotion) {
  const TriangleMesh body = star([](const Vector3d& p) { return figure(p, 0.05); });
  const TriangleMesh scan = moved(body, kStance.inverse());
  const Alignment found = align(patch_of(body), SeenSurface(scan, {}), Isometry3d::Identity());
  EXPECT_EQ(found.status, AlignmentStatus::converged);
  expect_same(found.patch_from_scan, kStance, 1e-5);  // m; ten times the last step
  EXPECT_LT(found.residual, 1e-5);
}

TEST(Align, TheSameTwiceBitForBit) {
  const TriangleMesh body = star([](const Vector3d& p) { return figure(p, 0.05); });
  const TriangleMesh scan = moved(body, kStance.inverse());
  const Alignment one = align(patch_of(body), SeenSurface(scan, {}), Isometry3d::Identity()),
                  two = align(patch_of(body), SeenSurface(scan, {}), Isometry3d::Identity());
  EXPECT_TRUE(one.patch_from_scan.matrix() == two.patch_from_scan.matrix());
}

// The bulges are a tenth of the skin, and half as high in the scan: less than the fifth that is trimmed.
TEST(Align, MovedSkinIsTrimmed) {
  const TriangleMesh body = star([](const Vector3d& p) { return figure(p, 0.05); });
  const TriangleMesh scan = moved(star([](const Vector3d& p) { return figure(p, 0.03); }), kStance.inverse());
  const Alignment found = align(patch_of(body), SeenSurface(scan, {}), Isometry3d::Identity());
  EXPECT_EQ(found.status, AlignmentStatus::converged);
  expect_same(found.patch_from_scan, kStance, 1e-3);  // m; the bulges differ by 20 mm
}

TEST(Align, UnseenSkinDoesNotCount) {
  const TriangleMesh body = star([](const Vector3d& p) { return figure(p); });
  TriangleMesh scan = moved(body, kStance.inverse());
  std::vector<char> filled(scan.vertices.size(), 0);
  for (std::size_t v = 0; v < filled.size(); ++v) {
    if (body.vertices[v].z() < 0.1) continue;
    filled[v] = 1;  // a filling that is far off
    scan.vertices[v] += Vector3d(0, 0, 0.05);
  }
  const Alignment found = align(patch_of(body), SeenSurface(scan, filled), Isometry3d::Identity());
  expect_same(found.patch_from_scan, kStance, 1e-3);  // m; the filling is 50 mm off
}

// A mesh from elsewhere has holes that nobody closed: their rims were taken for the nearest skin.
TEST(SeenSurface, TheRimOfAHoleIsNoSkinToBeComparedWith) {
  const TriangleMesh whole = star([](const Vector3d& p) { return figure(p); });
  TriangleMesh open = whole;
  const Vector3d hole = whole.vertices[whole.vertices.size() / 2];
  open.triangles.clear();
  for (const Eigen::Vector3i& t : whole.triangles)
    if ((whole.vertices[t[0]] - hole).norm() > 0.05) open.triangles.push_back(t);
  ASSERT_LT(open.triangles.size(), whole.triangles.size());
  const SeenSurface closed(whole, {}), surface(open, {});
  int in_hole = 0;
  for (const Vector3d& p : whole.vertices) {
    if (p.head<2>().norm() < 0.02) continue;  // a pole, where a star's triangles do not meet
    EXPECT_TRUE(closed.nearest(p).seen);
    const double away = (p - hole).norm();
    if (away < 0.03) {
      ++in_hole;
      EXPECT_FALSE(surface.nearest(p).seen);
    } else if (away > 0.08) {
      EXPECT_TRUE(surface.nearest(p).seen);
    }
  }
  EXPECT_GT(in_hole, 3);
}

TEST(Align, ASymmetricFigureStaysInItsPlane) {
  const TriangleMesh body = star([](const Vector3d& p) { return figure(p, 0.05); });
  const Isometry3d forward = motion(6, {0, 1, 0}, {0.02, 0, 0.01});  // keeps the plane y = 0
  const TriangleMesh scan = moved(body, forward.inverse());
  const Alignment found = align(patch_of(body), SeenSurface(scan, {}), Isometry3d::Identity());
  EXPECT_NEAR(found.patch_from_scan.translation().y(), 0, 1e-5);
  EXPECT_NEAR(found.patch_from_scan(1, 0), 0, 1e-4);
}

TEST(Align, ABallIsUndetermined) {
  const TriangleMesh ball = star([](const Vector3d&) { return 0.3; });
  EXPECT_EQ(align(patch_of(ball), SeenSurface(ball, {}), Isometry3d::Identity()).status,
            AlignmentStatus::undetermined);
}

TEST(Align, FarOrUnseenSkinIsTooLittle) {
  const TriangleMesh body = star([](const Vector3d& p) { return figure(p); });
  const std::vector<char> filled(body.vertices.size(), 1);
  EXPECT_EQ(align(patch_of(body), SeenSurface(body, filled), Isometry3d::Identity()).status,
            AlignmentStatus::too_little);
  EXPECT_EQ(align({}, SeenSurface(body, {}), Isometry3d::Identity()).status, AlignmentStatus::too_little);
}

}  // namespace
}  // namespace tensegric_fit::correlation
