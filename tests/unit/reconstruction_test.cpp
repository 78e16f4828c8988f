#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <thread>

#include "geometry/status.hpp"
#include "reconstruction/handles.hpp"
#include "reconstruction/reconstruct.hpp"
#include "reconstruction_figure.hpp"

namespace {

using namespace tensegric_fit;
using geometry::PointCloud;
using reconstruction::BodyMesh;
using reconstruction::Options;
using reconstruction::reconstruct;

constexpr double kNoise = 0.0005;

/// Small and coarse, so that the tests are quick: cells of 13 mm.
Options quick() {
  Options options;
  options.body_triangles = 12000;
  options.poisson_depth = 7;
  return options;
}

const PointCloud& booth() {
  static const PointCloud scan = figure::scan_booth(30000, kNoise);
  return scan;
}

const BodyMesh& body_of_booth() {
  static const BodyMesh body = reconstruct(booth(), quick());
  return body;
}

double percentile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1)));
}

/// Distances from the true surface of the vertices that the scan saw.
std::vector<double> errors(const BodyMesh& body, const Eigen::Isometry3d& figure_from_scan) {
  std::vector<double> result;
  for (std::size_t v = 0; v < body.filled.size(); ++v)
    if (!body.filled[v])
      result.push_back(std::abs(figure::distance(figure_from_scan * body.mesh.vertices[v])));
  return result;
}

/// Everything that later stages rely on.
void expect_sound(const BodyMesh& body, int triangles) {
  geometry::check_mesh(body.mesh);
  EXPECT_NO_THROW(geometry::edges_of(body.mesh));
  EXPECT_TRUE(geometry::is_closed(body.mesh));
  EXPECT_EQ(reconstruction::genus(body.mesh), 0);
  const auto component = geometry::components_of(body.mesh);
  EXPECT_EQ(*std::max_element(component.begin(), component.end()), 0) << "in one piece";
  EXPECT_GT(geometry::cone_volume(body.mesh.vertices, body.mesh.triangles, body.mesh.vertices.front()), 0);
  EXPECT_NEAR(static_cast<double>(body.mesh.triangles.size()), triangles, 0.01 * triangles);
  EXPECT_EQ(body.filled.size(), body.mesh.vertices.size());
}

std::string refusal_of(const PointCloud& scan, const Options& options = quick()) {
  try {
    reconstruct(scan, options);
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

PointCloud map(PointCloud cloud, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& f) {
  std::transform(cloud.points.begin(), cloud.points.end(), cloud.points.begin(), f);
  return cloud;
}

TEST(Reconstruction, AFigureBecomesOneClosedSurfaceOnItsPoints) {
  const BodyMesh& body = body_of_booth();
  expect_sound(body, 12000);
  const std::vector<double> error = errors(body, Eigen::Isometry3d::Identity());
  EXPECT_LT(percentile(error, 0.5), 0.0005);   // DESIGN §7
  EXPECT_LT(percentile(error, 0.95), 0.0015);  // DESIGN §7, creases between the capsules included
  // Floor and stray points are gone: nothing of the mesh lies off the figure by more than a bridged crease.
  for (const Eigen::Vector3d& v : body.mesh.vertices) EXPECT_LT(figure::distance(v), 0.02);
  EXPECT_LE(body.points_used, 30000u + 60u);  // of the stray points, those that lie on the figure
  EXPECT_GT(body.points_used, 29500u);        // the floor's neighbourhood takes the lowest few millimetres
}

TEST(Reconstruction, SolesLieOnTheFloor) {
  const auto box = geometry::bounding_box(body_of_booth().mesh.vertices);
  EXPECT_NEAR(box[0].z(), 0, 0.001);  // the floor's level is known to noise / sqrt(points)
  EXPECT_NEAR(box[1].z(), 1.63, 0.002);
}

TEST(Reconstruction, WithoutAFloorTheSolesLieBelowTheLowestPoints) {
  PointCloud scan = figure::scan_body(30000, kNoise, 1);
  scan.normals.clear();
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, 12000);
  EXPECT_NEAR(geometry::bounding_box(body.mesh.vertices)[0].z(), 0,
              0.004);  // the lowest points seen are at 6 mm
}

TEST(Reconstruction, TiltTurnAndFarOriginDoNotMatter) {
  Eigen::Isometry3d pose = Eigen::Translation3d(1e6, -2e6, 3e5) *
                           Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 1, 0).normalized()) *
                           Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ());
  const BodyMesh body =
      reconstruct(map(booth(), [&](const Eigen::Vector3d& p) { return pose * p; }), quick());
  expect_sound(body, 12000);
  const std::vector<double> error = errors(body, pose.inverse());
  EXPECT_LT(percentile(error, 0.5), 0.0005);
  EXPECT_LT(percentile(error, 0.95), 0.0015);
}

TEST(Reconstruction, GivenNormalsAndPointsThatAreNotFiniteAreCopedWith) {
  PointCloud scan = figure::scan_body(30000, kNoise, 1);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (i % 100 == 0) scan.normals[i] = -scan.normals[i];
    if (i % 100 == 1) scan.normals[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    if (i % 7 == 0) scan.points[i].x() = std::numeric_limits<double>::infinity();
    if (i % 11 == 0) scan.points[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, 12000);
  EXPECT_LT(percentile(errors(body, Eigen::Isometry3d::Identity()), 0.5), 0.0005);
}

TEST(Reconstruction, AHoleIsClosedAndReported) {
  const Eigen::Vector3d navel(0, -0.15, 1.05);
  constexpr double kRadius = 0.04;
  PointCloud scan = booth();
  auto& points = scan.points;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Eigen::Vector3d& p) { return (p - navel).norm() < kRadius; }),
               points.end());
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, 12000);
  // What is farther inside than `support_distance` counts as filled; points are some 6 mm apart, hence the
  // slack.
  const double inner = kRadius - quick().support_distance, expected = M_PI * inner * inner;
  const auto hole = std::min_element(body.holes.begin(), body.holes.end(), [&](const auto& a, const auto& b) {
    return (a.centre - navel).norm() < (b.centre - navel).norm();
  });
  ASSERT_NE(hole, body.holes.end());
  EXPECT_LT((hole->centre - navel).norm(), 0.01);
  EXPECT_NEAR(hole->area, expected, 0.5 * expected);
  EXPECT_GT(hole->confidence, 0.5);   // of 50 cm^2
  EXPECT_LT(hole->confidence, 0.85);  // of 4 cm^2
  double beside = 0, filled_beside = 0;
  for (std::size_t v = 0; v < body.filled.size(); ++v) {
    const Eigen::Vector3d& p = body.mesh.vertices[v];
    const double off = (p - navel).norm();
    if (off < 0.02) {
      EXPECT_TRUE(body.filled[v]);
    }
    if (off > 0.05 && p.z() > 0.95 && p.z() < 1.2 && std::abs(p.x()) < 0.1) {
      ++beside;
      filled_beside += body.filled[v];
    }
  }
  // 1.4 points a square centimetre: exp(-4.3) = 1.4 % of the skin has none within 10 mm.
  EXPECT_LT(filled_beside, 0.03 * beside);
}

TEST(Reconstruction, NoisyPointsGiveASurfaceFinerThanTheirNoise) {
  const BodyMesh body = reconstruct(figure::scan_booth(30000, 0.0015), quick());
  expect_sound(body, 12000);
  const std::vector<double> error = errors(body, Eigen::Isometry3d::Identity());
  EXPECT_LT(percentile(error, 0.5), 0.0007);  // the mean of some eight points of 1.5 mm noise
  EXPECT_LT(percentile(error, 0.95), 0.0020);
}

TEST(Reconstruction, DuplicatesCountOnce) {
  PointCloud scan = booth();
  for (int copy = 1; copy < 8; ++copy)
    scan.points.insert(scan.points.end(), booth().points.begin(), booth().points.end());
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, 12000);
  EXPECT_NEAR(static_cast<double>(body.points_used), body_of_booth().points_used, 5);
  EXPECT_LT(percentile(errors(body, Eigen::Isometry3d::Identity()), 0.95), 0.0015);
}

TEST(Reconstruction, AScanDenserThanHelpsIsThinned) {
  const BodyMesh body = reconstruct(figure::scan_booth(700000, 0.001), quick());
  expect_sound(body, 12000);
  EXPECT_LT(body.points_used, 400000u);  // as many points as time and memory are meant for
  EXPECT_LT(percentile(errors(body, Eigen::Isometry3d::Identity()), 0.5), 0.0005);
}

TEST(Reconstruction, ThirtyPercentOfStrayPointsDoNotMatter) {
  PointCloud scan = figure::scan_booth(60000, kNoise);
  std::mt19937 random(6);
  for (int i = 0; i < 34000; ++i)  // of some 114,000
    scan.points.emplace_back(1.6 * figure::uniform(random) - 0.8, 1.6 * figure::uniform(random) - 0.8,
                             1.8 * figure::uniform(random));
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, 12000);
  EXPECT_LT(percentile(errors(body, Eigen::Isometry3d::Identity()), 0.5), 0.0005);
}

TEST(Reconstruction, SameScanSameMeshEvenTwoAtOnce) {
  BodyMesh second, third;
  std::thread other([&] { second = reconstruct(booth(), quick()); });
  third = reconstruct(booth(), quick());
  other.join();
  for (const BodyMesh* body : {&second, &third}) {
    EXPECT_EQ(body->mesh.vertices, body_of_booth().mesh.vertices);
    EXPECT_EQ(body->mesh.triangles, body_of_booth().mesh.triangles);
    EXPECT_EQ(body->filled, body_of_booth().filled);
  }
}

TEST(Reconstruction, RefusesByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal_of({}), "empty_cloud");
  EXPECT_EQ(refusal_of(map(booth(), [&](const auto&) { return Eigen::Vector3d(nan, nan, nan); })),
            "non_finite");
  EXPECT_EQ(refusal_of(figure::scan_body(1000, 0, 1)), "too_few_points");
  PointCloud repeated;
  for (int i = 0; i < 20; ++i) {
    const PointCloud once = figure::scan_body(1000, 0, 1);
    repeated.points.insert(repeated.points.end(), once.points.begin(), once.points.end());
  }
  EXPECT_EQ(refusal_of(repeated), "too_few_points");
  EXPECT_EQ(refusal_of(map(booth(), [](const auto& p) { return Eigen::Vector3d(1000 * p); })), "wrong_unit");
  EXPECT_EQ(refusal_of(map(booth(), [](const auto& p) { return Eigen::Vector3d(39.37 * p); })), "wrong_unit");
  EXPECT_EQ(refusal_of(map(booth(), [](const auto&) { return Eigen::Vector3d(1, 2, 3); })), "not_a_body");
  PointCloud half = figure::scan_body(10000, 0, 1);
  half.normals.pop_back();
  EXPECT_EQ(refusal_of(half), "wrong_fields");
  Options small = quick();
  small.max_points = 10000;
  EXPECT_EQ(refusal_of(booth(), small), "too_many_points");
}

TEST(Reconstruction, RefusesWhatIsNoBody) {
  std::mt19937 random(3);
  PointCloud sphere, box, sheet, floor;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d n = figure::direction(random);
    const double u = figure::uniform(random), v = figure::uniform(random);
    sphere.points.push_back(0.6 * n);
    box.points.push_back(0.5 * n / n.lpNorm<Eigen::Infinity>());
    sheet.points.emplace_back(0.5 * u, 0, 1.7 * v);
    floor.points.emplace_back(2 * u, 2 * v, 0);
  }
  EXPECT_EQ(refusal_of(sphere), "not_a_body");
  EXPECT_EQ(refusal_of(box), "not_a_body");
  EXPECT_EQ(refusal_of(sheet), "not_a_body");
  EXPECT_EQ(refusal_of(floor), "not_a_body");
  // A fish: long, lying, small.
  EXPECT_EQ(
      refusal_of(map(sphere, [](const auto& p) { return Eigen::Vector3d(p.x(), 0.1 * p.y(), 0.3 * p.z()); })),
      "not_a_body");
}

TEST(Reconstruction, RefusesOptionsOutOfRangeByTheirName) {
  const auto message_with = [](const std::function<void(Options&)>& change) {
    Options options = quick();
    change(options);
    try {
      reconstruct(booth(), options);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code() + ": " + refusal.what();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message_with([](Options& o) { o.body_triangles = 10; }).find("bad_option: body_triangles"), 0u);
  EXPECT_EQ(message_with([](Options& o) { o.poisson_depth = 20; }).find("bad_option: poisson_depth"), 0u);
  EXPECT_EQ(message_with([](Options& o) { o.min_points = -1; }).find("bad_option: min_points"), 0u);
  EXPECT_EQ(message_with([](Options& o) { o.max_points = 0; }).find("bad_option: max_points"), 0u);
  EXPECT_EQ(message_with([](Options& o) {
              o.support_distance = std::nan("");
            }).find("bad_option: support_distance"),
            0u);
}

}  // namespace
