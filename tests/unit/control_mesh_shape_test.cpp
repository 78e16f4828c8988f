// Control meshes on shapes that are no bodies (P1 §3.2, Fig. 3).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "control_mesh/shape_control.hpp"
#include "geometry/status.hpp"
#include "refusal_of.hpp"

namespace tensegric_fit {
namespace {

using control_mesh::ShapeFixing;
using Eigen::Vector3d;
using geometry::TriangleMesh;

// A closed lens of radius 0.5 m round `centre`, 2 * `height` thick in its middle and sharp at its rim.
TriangleMesh lens(double height, const Vector3d& centre = Vector3d::Zero()) {
  constexpr int kRings = 12, kSectors = 36;
  TriangleMesh mesh;
  for (double side : {1.0, -1.0}) {
    mesh.vertices.push_back(centre + Vector3d(0, 0, side * height));
    for (int i = 1; i < kRings; ++i)
      for (int k = 0; k < kSectors; ++k) {
        const double r = double(i) / kRings, angle = 2 * M_PI * k / kSectors;
        mesh.vertices.push_back(centre + Vector3d(0.5 * r * std::cos(angle), 0.5 * r * std::sin(angle),
                                                  side * height * (1 - r * r)));
      }
  }
  const int half = static_cast<int>(mesh.vertices.size()) / 2, rim = 2 * half;
  for (int k = 0; k < kSectors; ++k) {
    const double angle = 2 * M_PI * k / kSectors;
    mesh.vertices.push_back(centre + Vector3d(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0));
  }
  const auto at = [&](int side, int ring, int k) {
    return ring == 0 ? side * half
                     : (ring == kRings ? rim : side * half + 1 + (ring - 1) * kSectors) + k % kSectors;
  };
  for (int side : {0, 1})
    for (int ring = 0; ring < kRings; ++ring)
      for (int k = 0; k < kSectors; ++k) {
        const auto add = [&](int a, int b, int c) {
          mesh.triangles.push_back(side == 0 ? Eigen::Vector3i(a, b, c) : Eigen::Vector3i(a, c, b));
        };
        add(at(side, ring, k), at(side, ring + 1, k), at(side, ring + 1, k + 1));
        if (ring > 0) add(at(side, ring, k), at(side, ring + 1, k + 1), at(side, ring, k + 1));
      }
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh beside(TriangleMesh mesh, const TriangleMesh& other) {
  const int nodes = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Eigen::Vector3i& t : other.triangles)
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(nodes));
  return mesh;
}

// A cube of 1 m with a strip of its upper face, beside the edge over x = 1, in two triangles of its own.
TriangleMesh cube_with_strip(double width) {
  const std::vector<std::pair<double, double>> outline{
      {0, 0}, {1, 0}, {1, 1}, {1 - width, 1}, {0, 1}};  // x, z
  const int count = static_cast<int>(outline.size());
  TriangleMesh cube;
  for (const double y : {0.0, 1.0})
    for (const auto& [x, z] : outline) cube.vertices.emplace_back(x, y, z);
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    cube.triangles.emplace_back(i, count + next, next);
    cube.triangles.emplace_back(i, count + i, count + next);
  }
  for (int i = 1; i + 1 < count; ++i) {
    cube.triangles.emplace_back(0, i, i + 1);
    cube.triangles.emplace_back(count, count + i + 1, count + i);
  }
  return cube;
}

ShapeFixing behind(double x) {
  ShapeFixing fixing;
  fixing.boxes = {{Vector3d(-10, -10, -10), Vector3d(x, 10, 10)}};
  return fixing;
}

TEST(ShapeControl, InnerNodesStayOnTheirSideOfAThinShape) {
  constexpr double kHeight = 0.01;  // the mean edge is some 50 mm
  const TriangleMesh mesh = lens(kHeight);
  ASSERT_TRUE(geometry::is_closed(mesh));
  const auto control = control_mesh::control_from_shape(mesh, behind(-0.3));
  for (std::size_t v = 0; v < control.outer.size(); ++v) {
    const Vector3d &outer = control.outer[v], &inner = control.inner[v];
    EXPECT_GT((outer - inner).norm(), 0);
    if (outer.z() == 0) continue;  // the rim
    const double surface = kHeight * (1 - 4 * inner.head<2>().squaredNorm());
    EXPECT_GT(inner.z() * outer.z(), 0);
    EXPECT_LT(std::abs(inner.z()), surface);
  }
  for (const Eigen::Vector3i& t : control.triangles)
    EXPECT_GT(geometry::area_vector(control.inner[t[0]], control.inner[t[1]], control.inner[t[2]])
                  .dot(geometry::area_vector(control.outer[t[0]], control.outer[t[1]], control.outer[t[2]])),
              0);
}

TEST(ShapeControl, ThicknessIsWhatWasAskedForWhereThereIsRoom) {
  ShapeFixing fixing = behind(-0.3);
  fixing.thickness = 0.03;
  const auto control = control_mesh::control_from_shape(lens(0.4), fixing);
  EXPECT_NEAR((control.outer[0] - control.inner[0]).norm(), 0.03, 1e-12);
}

TEST(ShapeControl, EachPieceKeepsItsOwnVolume) {
  const TriangleMesh two = beside(lens(0.1), lens(0.2, {0, 0, 1}));
  const int triangles = static_cast<int>(two.triangles.size()) / 2;
  const auto control = control_mesh::control_from_shape(two, behind(-0.3));
  ASSERT_EQ(control.regions.size(), 2u);
  EXPECT_EQ(control.regions[0].name, "shape");
  EXPECT_EQ(control.regions[1].name, "shape_2");
  for (int piece : {0, 1}) {
    EXPECT_EQ(static_cast<int>(control.regions[piece].triangles.size()), triangles);
    for (int t : control.regions[piece].triangles) EXPECT_EQ(t / triangles, piece);
  }
  ShapeFixing one = behind(10);
  one.boxes[0][1].z() = 0.5;  // nothing holds the upper one
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(two, one); }), "bad_template");
}

TEST(ShapeControl, APieceThatIsInsideOutIsAHollowOrRefused) {
  TriangleMesh hollow = inside_out(lens(0.2));
  for (Vector3d& p : hollow.vertices) p *= 0.5;
  TriangleMesh apart = hollow;
  for (Vector3d& p : apart.vertices) p.z() += 1;
  const auto refused = [](const TriangleMesh& mesh) {
    ASSERT_GT(geometry::cone_volume(mesh.vertices, mesh.triangles), 0);
    EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(mesh, behind(-0.1)); }), "bad_mesh");
  };
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(beside(lens(0.2), hollow), behind(-0.1)); }),
            "accepted");
  refused(beside(lens(0.2), apart));
  refused(beside(apart, lens(0.2)));
}

TEST(ShapeControl, UnitsThatStayFoldedAreRefused) {
  const TriangleMesh cube = cube_with_strip(1e-5);
  ASSERT_TRUE(geometry::is_closed(cube));
  ShapeFixing fixing = behind(0.5);
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(cube, fixing); }), "bad_template");
  fixing.thickness = 1e-4;
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(cube, fixing); }), "accepted");
  fixing.thickness = 0;
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(cube_with_strip(0.3), fixing); }), "accepted");
}

TEST(ShapeControl, SimplifiedToAboutTheTrianglesAskedFor) {
  const auto control = control_mesh::simplified_control(lens(0.2), behind(-0.3), 200);
  EXPECT_NEAR(static_cast<double>(control.triangles.size()), 200, 1);
  EXPECT_TRUE(geometry::is_closed({control.outer, control.triangles}));
  for (std::size_t v = 0; v < control.outer.size(); ++v)
    EXPECT_EQ(control.outer_fixed[v] != 0, control.outer[v].x() <= -0.3);
  ShapeFixing numbered = behind(-0.3);
  numbered.nodes = {0, 1, 2};
  EXPECT_EQ(refusal_of([&] { control_mesh::simplified_control(lens(0.2), numbered, 200); }), "bad_template");
}

TEST(ShapeControl, VerticesWithoutATriangleAreNoneOfTheControlMesh) {
  const TriangleMesh mesh = lens(0.2);
  TriangleMesh loose = mesh;
  loose.vertices.insert(loose.vertices.begin() + 3, Vector3d(0, 0, 1));
  for (Eigen::Vector3i& t : loose.triangles)
    for (int& v : t) v += v >= 3 ? 1 : 0;
  const auto control = control_mesh::simplified_control(mesh, behind(-0.3), 200),
             same = control_mesh::simplified_control(loose, behind(-0.3), 200);
  EXPECT_EQ(same.outer, control.outer);
  EXPECT_EQ(same.triangles, control.triangles);
}

TEST(ShapeControl, RefusalsHaveNames) {
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(inside_out(lens(0.2)), behind(-0.3)); }),
            "bad_mesh");
  EXPECT_EQ(refusal_of([&] { control_mesh::simplified_control({}, behind(0), 200); }), "bad_mesh");
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(lens(0.2), behind(-0.6)); }), "bad_template");
  const TriangleMesh point{std::vector<Vector3d>(9, Vector3d(1, 2, 3)), {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(point, behind(10)); }), "bad_mesh");
  ShapeFixing numbered;
  numbered.nodes = {100000};
  EXPECT_EQ(refusal_of([&] { control_mesh::control_from_shape(lens(0.2), numbered); }), "bad_template");
}

TEST(ShapeControl, FilesAreReadWithCare) {
  const auto path =
      std::filesystem::temp_directory_path() / ("tensegric_fit_shape_" + std::to_string(getpid()) + ".yaml");
  const auto load = [&](const std::string& text) {
    std::ofstream(path) << text;
    return control_mesh::load_shape_fixing(path.string());
  };
  const ShapeFixing fixing =
      load("nodes: [0, 5]\nboxes: [{min: [0, 1, 2], max: [3, 4, 5]}]\nthickness: 0.01\n");
  EXPECT_EQ(fixing.nodes, (std::vector<int>{0, 5}));
  ASSERT_EQ(fixing.boxes.size(), 1u);
  EXPECT_EQ(fixing.boxes[0][1], Vector3d(3, 4, 5));
  EXPECT_EQ(fixing.thickness, 0.01);
  for (const char* text :
       {"colour: red\n", "thickness: 0\n", "boxes: {min: [0, 0, 0]}\n",
        "boxes: [{min: [0, 0], max: [1, 1, 1]}]\n", "boxes: [{min: [0, 0, 0]}]\n",
        "boxes: [{min: [0, 0, 1], max: [1, 1, 0]}]\n", "boxes: [{min: [0, 0, .nan], max: [1, 1, 1]}]\n"})
    EXPECT_EQ(refusal_of([&] { load(text); }), "bad_template") << text;
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace tensegric_fit
