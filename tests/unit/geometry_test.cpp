#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>

#include "geometry/checked_yaml.hpp"
#include "geometry/control_mesh.hpp"
#include "geometry/ply.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/scan_stamp.hpp"
#include "geometry/section.hpp"
#include "geometry/shading_normals.hpp"
#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"
#include "refusal_of.hpp"

namespace tensegric_fit::geometry {
namespace {

// Sphere of latitude and longitude, closed, oriented outwards.
TriangleMesh sphere(double radius, int rings, int sectors) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, -radius);
  for (int i = 1; i < rings; ++i) {
    const double latitude = M_PI * i / rings;
    for (int j = 0; j < sectors; ++j) {
      const double longitude = 2 * M_PI * j / sectors;
      mesh.vertices.emplace_back(radius * std::sin(latitude) * std::cos(longitude),
                                 radius * std::sin(latitude) * std::sin(longitude),
                                 -radius * std::cos(latitude));
    }
  }
  mesh.vertices.emplace_back(0, 0, radius);
  const auto at = [&](int ring, int sector) { return 1 + (ring - 1) * sectors + sector % sectors; };
  const int north = static_cast<int>(mesh.vertices.size()) - 1;
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.emplace_back(0, at(1, j + 1), at(1, j));
    mesh.triangles.emplace_back(north, at(rings - 1, j), at(rings - 1, j + 1));
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j));
      mesh.triangles.emplace_back(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  return mesh;
}

std::string scratch_file(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("tensegric_fit_" + std::to_string(getpid()) + "_" + name))
      .string();
}

TEST(TriangleMesh, SphereIsClosedAndItsVolumeDoesNotDependOnTheApex) {
  const TriangleMesh mesh = sphere(0.3, 60, 120);
  EXPECT_TRUE(is_closed(mesh));
  const double exact = 4.0 / 3 * M_PI * 0.027;
  const double volume = cone_volume(mesh.vertices, mesh.triangles);
  EXPECT_NEAR(volume, exact, 3e-3 * exact);  // the facets lie inside: error falls as 1/n^2
  EXPECT_LT(volume, exact);
  EXPECT_NEAR(volume, cone_volume(mesh.vertices, mesh.triangles, Eigen::Vector3d(3, -2, 1)), 1e-12);
}

TEST(TriangleMesh, EdgesObeyEuler) {
  const TriangleMesh mesh = sphere(1, 20, 30);
  const auto edges = edges_of(mesh);
  EXPECT_EQ(mesh.vertices.size() - edges.size() + mesh.triangles.size(), 2u);
  for (const Edge& edge : edges) EXPECT_GE(edge.right, 0);
}

TEST(TriangleMesh, AnOpenMeshIsNotClosedAndItsBoundaryIsFound) {
  TriangleMesh mesh = sphere(1, 10, 12);
  std::vector<char> keep(mesh.triangles.size(), 1);
  keep[3] = 0;
  mesh = submesh(mesh, keep);
  EXPECT_FALSE(is_closed(mesh));
  int boundary = 0;
  for (const Edge& edge : edges_of(mesh)) boundary += edge.right < 0;
  EXPECT_EQ(boundary, 3);
}

TEST(TriangleMesh, NormalsOfASpherePointOutwards) {
  const TriangleMesh mesh = sphere(2, 40, 60);
  const auto normals = vertex_normals(mesh.vertices, mesh.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v)
    EXPECT_GT(normals[v].dot(mesh.vertices[v].normalized()), 0.99);
}

TEST(ShadingNormals, NoiseIsShadedLessAndAnEdgeStays) {
  TriangleMesh ball = sphere(1, 40, 60);
  const std::vector<Eigen::Vector3d> smooth = ball.vertices;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-0.01, 0.01);
  for (Eigen::Vector3d& v : ball.vertices) v *= 1 + noise(random);
  const auto mean_error = [&](const std::vector<Eigen::Vector3d>& normals) {
    double sum = 0;
    for (std::size_t v = 0; v < normals.size(); ++v)
      sum += std::acos(std::min(1.0, normals[v].dot(smooth[v].normalized())));
    return sum / static_cast<double>(normals.size());
  };
  EXPECT_LT(mean_error(shading_normals(ball.vertices, ball.triangles)),
            0.7 * mean_error(vertex_normals(ball.vertices, ball.triangles)));

  // a roof of two planes with two rows of vertices on each: away from the ridge they keep their own normal
  const std::vector<Eigen::Vector3d> roof{{0, -2, 0}, {1, -2, 0}, {0, -1, 1}, {1, -1, 1}, {0, 0, 2},
                                          {1, 0, 2},  {0, 1, 1},  {1, 1, 1},  {0, 2, 0},  {1, 2, 0}};
  std::vector<Eigen::Vector3i> tiles;
  for (int row = 0; row < 8; row += 2) {
    tiles.emplace_back(row, row + 1, row + 3);
    tiles.emplace_back(row, row + 3, row + 2);
  }
  const std::vector<Eigen::Vector3d> normals = shading_normals(roof, tiles);
  EXPECT_NEAR(normals[0].dot(Eigen::Vector3d(0, -1, 1).normalized()), 1, 1e-3);
  EXPECT_NEAR(normals[4].z(), 1, 0.1);
}

TEST(TriangleMesh, ComponentsAreCounted) {
  TriangleMesh two = sphere(1, 6, 8);
  const int offset = static_cast<int>(two.vertices.size());
  const TriangleMesh other = sphere(1, 6, 8);
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) two.triangles.push_back(t + Eigen::Vector3i::Constant(offset));
  const auto component = components_of(two);
  EXPECT_EQ(component.front(), 0);
  EXPECT_EQ(component.back(), 1);
}

TEST(TriangleMesh, BadMeshesAreRefusedByName) {
  TriangleMesh mesh = sphere(1, 6, 8);
  mesh.triangles[0][1] = 10000;
  EXPECT_EQ(refusal_of([&] { check_mesh(mesh); }), "bad_mesh");
  mesh = sphere(1, 6, 8);
  mesh.vertices[4].x() = NAN;
  EXPECT_EQ(refusal_of([&] { check_mesh(mesh); }), "non_finite");
  mesh = sphere(1, 6, 8);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_EQ(refusal_of([&] { edges_of(mesh); }), "bad_mesh");
  EXPECT_FALSE(is_closed(mesh));
}

TEST(Section, OfASphereIsOneCounterClockwiseCircle) {
  const TriangleMesh mesh = sphere(0.5, 100, 200);
  const double height = 0.2, radius = std::sqrt(0.25 - 0.04);
  const auto loops = plane_section(mesh, {0, 0, height}, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_TRUE(loops[0].closed);
  EXPECT_EQ(loops[0].points.size(), loops[0].triangles.size());
  EXPECT_NEAR(length_of(loops[0].points, true), 2 * M_PI * radius, 1e-3 * radius);
  double twice_area = 0;
  for (std::size_t i = 0; i < loops[0].points.size(); ++i) {
    const Eigen::Vector3d &a = loops[0].points[i], &b = loops[0].points[(i + 1) % loops[0].points.size()];
    EXPECT_NEAR(a.z(), height, 1e-12);
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  EXPECT_GT(twice_area, 0);
}

TEST(Section, ThroughAVertexIsStillWhole) {
  const TriangleMesh mesh = sphere(1, 10, 12);  // z = 0 runs along a ring of vertices
  const auto loops = plane_section(mesh, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_TRUE(loops[0].closed);
}

TEST(Section, OfAnOpenMeshIsOneOpenPolyline) {
  TriangleMesh mesh = sphere(1, 10, 12);
  std::vector<char> keep(mesh.triangles.size(), 1);
  for (std::size_t t = 0; t < keep.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (mesh.vertices[mesh.triangles[t][k]].y() < -0.3) keep[t] = 0;
  const auto loops = plane_section(submesh(mesh, keep), {0, 0, 0.05}, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_FALSE(loops[0].closed);
  EXPECT_EQ(loops[0].points.size(), loops[0].triangles.size() + 1);
}

TEST(Tape, BridgesHollows) {
  // a square with a notch: the tape is the square
  const std::vector<Eigen::Vector3d> points{{0, 0, 1},     {1, 0, 1}, {1, 1, 1},
                                            {0.5, 0.2, 1}, {0, 1, 1}, {0.5, 0, 1}};
  const auto loop = tape(points, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(loop.size(), 4u);
  EXPECT_NEAR(length_of(loop, true), 4, 1e-12);
}

TEST(ControlMesh, VolumeOfAnOpenPatchFollowsItsNodes) {
  ControlMesh control;  // a pyramid without its base
  control.outer = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};
  control.inner = control.outer;
  control.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  control.outer_fixed = control.inner_fixed = std::vector<char>(5, 0);
  control.names = {"a", "", "", "", "tip"};
  control.regions = {{"all", {0, 1, 2, 3}}};
  check_control_mesh(control);
  ControlMesh loose = control;  // a node that no triangle has: it has no normal, below it is nowhere
  loose.outer.emplace_back(3, 0, 0);
  loose.inner.emplace_back(3, 0, -1);
  loose.outer_fixed.push_back(0);
  loose.inner_fixed.push_back(0);
  loose.names.emplace_back();
  EXPECT_THROW(check_control_mesh(loose), Refusal);
  EXPECT_EQ(control.node("tip"), 4);
  EXPECT_EQ(control.node(""), -1);
  const auto volume = [&](const std::vector<Eigen::Vector3d>& outer) {
    return cone_volume(outer, region_triangles(control, control.regions[0]),
                       region_apex(control, control.regions[0]));
  };
  auto raised = control.outer;
  raised[4].z() += 0.5;
  EXPECT_NEAR(volume(raised) - volume(control.outer), 4.0 * 0.5 / 3,
              1e-12);  // base area 4
  EXPECT_EQ(route_over_edges(control, {0, 2}, "chest"), (std::vector<int>{0, 4, 2}));
  EXPECT_EQ(refusal_of([&] {
              control.triangles.pop_back();
              control.triangles.pop_back();
              control.triangles.pop_back();
              route_over_edges(control, {0, 3}, "chest");
            }),
            "unknown_line");
}

TEST(Ply, RoundTripKeepsVertexOrder) {
  const TriangleMesh mesh = sphere(1, 6, 8);
  const std::string path = scratch_file("round.ply");
  write_ply_mesh(path, mesh);
  const TriangleMesh back = read_ply_mesh(path);
  ASSERT_EQ(back.vertices.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_LT((back.vertices[v] - mesh.vertices[v]).norm(), 1e-7);  // float32
  EXPECT_EQ(back.triangles, mesh.triangles);
  write_ply_mesh(path, mesh, {}, Coordinates::float64);
  EXPECT_EQ(read_ply_mesh(path).vertices, mesh.vertices);  // to the last bit
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 10);
  EXPECT_EQ(refusal_of([&] { read_ply_mesh(path); }), "broken_file");
  std::filesystem::resize_file(path, 40);
  EXPECT_EQ(refusal_of([&] { read_ply_mesh(path); }), "broken_file");
  std::filesystem::resize_file(path, 0);
  EXPECT_EQ(refusal_of([&] { read_ply_mesh(path); }), "broken_file");
  std::filesystem::remove(path);
  EXPECT_EQ(refusal_of([&] { read_ply_mesh(path); }), "broken_file");
}

TEST(Ply, AHeaderThatPromisesTooMuchIsBroken) {
  const std::string path = scratch_file("promise.ply");
  std::ofstream(path)
      << "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty "
         "float y\nproperty float z\nend_header\nabc";
  EXPECT_EQ(refusal_of([&] { read_ply_mesh(path); }), "broken_file");
  std::filesystem::remove(path);
}

pcl::PCLPointCloud2 cloud_of(const std::vector<pcl::PCLPointField>& fields, std::uint32_t step,
                             std::uint32_t count) {
  pcl::PCLPointCloud2 cloud;
  cloud.fields = fields;
  cloud.point_step = step;
  cloud.width = count;
  cloud.height = 1;
  cloud.row_step = step * count;
  cloud.data.resize(cloud.row_step);
  return cloud;
}

TEST(PointFields, ReadsDoublesInAnyOrderWithPadding) {
  using F = pcl::PCLPointField;
  pcl::PCLPointCloud2 cloud =
      cloud_of({{"z", 4, F::FLOAT64, 1}, {"x", 12, F::FLOAT64, 1}, {"y", 24, F::FLOAT64, 1}}, 40, 2);
  const double xyz[2][3] = {{1, 2, 3}, {4, 5, NAN}};
  for (int i = 0; i < 2; ++i) {
    std::memcpy(&cloud.data[40 * i + 12], &xyz[i][0], 8);
    std::memcpy(&cloud.data[40 * i + 24], &xyz[i][1], 8);
    std::memcpy(&cloud.data[40 * i + 4], &xyz[i][2], 8);
  }
  const PointCloud points = points_of(cloud);
  ASSERT_EQ(points.points.size(), 2u);
  EXPECT_EQ(points.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(std::isnan(points.points[1].z()));
  EXPECT_TRUE(points.normals.empty());
}

TEST(PointFields, RefusesWrongFieldsAndShortData) {
  using F = pcl::PCLPointField;
  EXPECT_EQ(refusal_of([] {
              points_of(cloud_of({{"x", 0, F::FLOAT32, 1}, {"y", 4, F::FLOAT32, 1}}, 8, 3));
            }),
            "wrong_fields");
  EXPECT_EQ(
      refusal_of([] {
        points_of(cloud_of({{"x", 0, F::INT32, 1}, {"y", 4, F::INT32, 1}, {"z", 8, F::INT32, 1}}, 12, 3));
      }),
      "wrong_fields");
  EXPECT_EQ(refusal_of([] {
              points_of(cloud_of({{"x", 0, F::FLOAT32, 1}, {"y", 4, F::FLOAT32, 1}, {"z", 10, F::FLOAT32, 1}},
                                 12, 3));
            }),
            "wrong_fields");
  pcl::PCLPointCloud2 cut =
      cloud_of({{"x", 0, F::FLOAT32, 1}, {"y", 4, F::FLOAT32, 1}, {"z", 8, F::FLOAT32, 1}}, 12, 3);
  cut.data.resize(30);
  EXPECT_EQ(refusal_of([&] { points_of(cut); }), "broken_file");
}

TEST(CheckedYaml, NamesTheKey) {
  const YAML::Node map = YAML::Load("{ratio: 0.9, colour: red}");
  try {
    check_keys(map, {"ratio"}, "line chest", "bad_garment");
    FAIL() << "accepted";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "bad_garment");
    EXPECT_NE(std::string(refusal.what()).find("colour"), std::string::npos);
  }
  EXPECT_EQ(refusal_of([] {
              check_keys(YAML::Load("{ratio: 0.9, ratio: 0.8}"), {"ratio"}, "line chest", "bad_garment");
            }),
            "bad_garment");
  EXPECT_EQ(number_in(map, "ratio", 0.5, 1, "line", "bad_garment"), 0.9);
  EXPECT_EQ(refusal_of([&] { number_in(map, "ratio", 0.95, 1, "line", "bad_garment"); }), "bad_garment");
  EXPECT_EQ(refusal_of([&] { number_in(map, "colour", 0, 1, "line", "bad_garment"); }), "bad_garment");
  EXPECT_EQ(refusal_of([&] { required<double>(map, "law", "line", "bad_garment"); }), "bad_garment");
}

TEST(Day, IsOfTheMachinesTimeZoneAndOfClocksThatAreSet) {
  const char* const zone = std::getenv("TZ");
  const std::string before = zone == nullptr ? "" : zone;
  setenv("TZ", "JST-9", 1);
  tzset();
  EXPECT_EQ(geometry::day_of(1796050800), "2026-12-01");  // 15:00 of the day before, UTC
  for (const double odd : {0.0, -5.0, 1e300, std::nan("")}) EXPECT_EQ(geometry::day_of(odd), "") << odd;
  if (zone == nullptr)
    unsetenv("TZ");
  else
    setenv("TZ", before.c_str(), 1);
  tzset();
}

TEST(JoinedMeshes, KeepsPiecesApartAndNumbersOn) {
  ControlMesh one;
  one.outer = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.inner = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
  one.triangles = {{0, 1, 2}};
  one.outer_fixed = one.inner_fixed = {1, 0, 0};
  one.names = {"a", "", ""};
  one.regions = {{"bust", {0}}};
  one.lines = {{"chest", {0, 1}}};
  ControlMesh other = one;
  for (auto* layer : {&other.outer, &other.inner})
    for (Eigen::Vector3d& p : *layer) p.z() += 5;
  other.names[0] = "b";
  EXPECT_THROW(joined({one, other}), Refusal);  // both have a region bust
  other.regions[0].name = "hips";
  EXPECT_THROW(joined({one, other}), Refusal);  // both have a line chest
  other.lines[0].name = "hip";
  const ControlMesh both = joined({one, other});
  EXPECT_NO_THROW(check_control_mesh(both));
  EXPECT_EQ(both.triangles[1], Eigen::Vector3i(3, 4, 5));
  EXPECT_EQ(both.regions[1].triangles, std::vector<int>{1});
  EXPECT_EQ(both.lines[1].nodes, (std::vector<int>{3, 4}));
  EXPECT_EQ(both.node("b"), 3);
  EXPECT_EQ(both.outer[3], other.outer[0]);
  other.names[0] = "a";
  EXPECT_THROW(joined({one, other}), Refusal);
}

}  // namespace
}  // namespace tensegric_fit::geometry
