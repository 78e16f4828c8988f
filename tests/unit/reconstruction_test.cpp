// Scans of women of the virtual booth, whose skin is known, and scans that are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <thread>

#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "geometry/surface_tree.hpp"
#include "measured_body.hpp"
#include "reconstruction/handles.hpp"
#include "reconstruction/unseen_skin.hpp"
#include "reconstruction_figure.hpp"
#include "virtual_booth/random_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit {
namespace {

using geometry::PointCloud;
using reconstruction::BodyMesh;
using reconstruction::Options;

constexpr double kNoise = 0.0008;
constexpr int kTriangles = 40000;

/// Coarser than usual, so that the tests are quick: cells of 7 mm.
Options quick() {
  Options options;
  options.body_triangles = kTriangles;
  options.poisson_depth = 8;
  return options;
}

/// She stands in the booth's frame, on z = 0.
const virtual_body::VirtualBody& woman() {
  static const virtual_body::VirtualBody body =
      virtual_booth::random_customer(virtual_booth::Family::model, 3);
  return body;
}

const geometry::SurfaceTree& skin() {
  static const geometry::SurfaceTree tree(woman().mesh);
  return tree;
}

/// Scans of her, without normals; `floor`: as far as 0.6 m around.
const PointCloud& scan_of(int points, double noise, bool floor) {
  static std::map<std::tuple<int, double, bool>, PointCloud> scans;
  const auto [scan, is_new] = scans.emplace(std::tuple(points, noise, floor), PointCloud());
  if (is_new) {
    virtual_booth::ScannerOptions options;
    options.points = points;
    options.noise = noise;
    options.misregistration = 0;
    options.floor = floor;
    scan->second = virtual_booth::scan_body(woman().mesh, options).cloud;
  }
  return scan->second;
}

const PointCloud& booth_scan() {
  return scan_of(100000, kNoise, true);
}

BodyMesh reconstruct(const PointCloud& scan, const Options& options) {
  return test::reconstructed(scan, options).body;
}

const reconstruction::Reconstruction& her() {
  static const reconstruction::Reconstruction result = test::reconstructed(booth_scan(), quick());
  return result;
}

double percentile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1)));
}

double distance(const Eigen::Vector3d& p) {
  return (skin().nearest(p).position - p).norm();
}

/// Distances from the true surface of the vertices that the scan saw.
std::vector<double> errors(const BodyMesh& body,
                           const Eigen::Isometry3d& booth_from_scan = Eigen::Isometry3d::Identity()) {
  std::vector<double> result;
  for (std::size_t v = 0; v < body.filled.size(); ++v)
    if (!body.filled[v]) result.push_back(distance(booth_from_scan * body.mesh.vertices[v]));
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

TEST(Reconstruction, AWomanBecomesOneClosedSurfaceOnHerSkin) {
  const BodyMesh& body = her().body;
  expect_sound(body, kTriangles);
  const std::vector<double> error = errors(body);
  EXPECT_LT(percentile(error, 0.5), 0.0005);   // asked of noise of 1 mm and less
  EXPECT_LT(percentile(error, 0.95), 0.0015);  // asked of noise of 1 mm and less
  // Floor and stray points are gone; what was not seen lies near the skin too.
  for (const Eigen::Vector3d& v : body.mesh.vertices) EXPECT_LT(distance(v), 0.02);
  std::size_t on_skin = 0;
  for (const Eigen::Vector3d& p : booth_scan().points) on_skin += p.z() > 0.01 && distance(p) < 0.005;
  EXPECT_NEAR(static_cast<double>(body.points_used), on_skin,
              0.02 * on_skin);  // soles, and stray points on them
}

TEST(Reconstruction, TheModelIsInTheScansFrame) {
  const body_model::RegisteredBody& model = her().model;
  EXPECT_TRUE(model.scanned);
  EXPECT_LT((model.vertical - Eigen::Vector3d::UnitZ()).norm(),
            0.002);  // the floor's normal: 1 mm over 0.6 m
  EXPECT_NEAR(model.ground, 0, 0.001);
  EXPECT_EQ(model.ground_deviation, 0);  // the floor was seen
  std::vector<double> off;
  for (const Eigen::Vector3d& v : model.skin) off.push_back(distance(v));
  EXPECT_LT(percentile(off, 0.5), 0.001);
  EXPECT_LT(percentile(off, 0.95), 0.004);
}

TEST(Reconstruction, SolesLieOnTheFloor) {
  const auto box = geometry::bounding_box(her().body.mesh.vertices);
  EXPECT_NEAR(box[0].z(), 0, 0.001);  // the floor's level is known to noise / sqrt(points)
  EXPECT_NEAR(box[1].z(), woman().truth.height("stature"), 0.003);
}

/// On a round plate of that height, which stands on the floor; what it hides of that is not seen.
PointCloud on_plate(double height) {
  constexpr double kRadius = 0.22, kSpacing = 0.003;
  PointCloud scan;
  std::vector<Eigen::Vector3d> low;  // of her, from above
  for (const Eigen::Vector3d& p : booth_scan().points) {
    if (p.z() < 0.005) {
      if (p.head<2>().norm() > kRadius) scan.points.push_back(p);
      continue;
    }
    scan.points.emplace_back(p + height * Eigen::Vector3d::UnitZ());
    if (p.z() < 0.06) low.emplace_back(p.x(), p.y(), 0);
  }
  const geometry::PointTree feet(low);
  for (double x = -kRadius; x < kRadius; x += kSpacing)
    for (double y = -kRadius; y < kRadius; y += kSpacing)
      if (std::hypot(x, y) < kRadius &&
          !feet.any_within({x, y, 0}, 0.012, [](int) { return true; }))  // beneath them it is not seen
        scan.points.emplace_back(x, y, height + kNoise * std::sin(1e4 * x + 7e3 * y));
  for (double turn = 0; turn < 2 * M_PI; turn += kSpacing / kRadius)
    for (double z = kSpacing; z < height; z += kSpacing)
      scan.points.emplace_back(kRadius * std::cos(turn), kRadius * std::sin(turn), z);
  return scan;
}

TEST(Reconstruction, OnAPlateSheIsNoTaller) {
  for (const double height : {0.018, 0.025, 0.045}) {
    const reconstruction::Reconstruction result = test::reconstructed(on_plate(height), quick());
    expect_sound(result.body, kTriangles);
    EXPECT_NEAR(result.model.ground, height, 0.002);
    EXPECT_EQ(result.model.ground_deviation, 0);
    EXPECT_LT(result.model.residual, 1.3 * her().model.residual);  // the plate is no misfit of hers
    const auto box = geometry::bounding_box(result.body.mesh.vertices);
    EXPECT_NEAR(box[0].z(), height, 0.002);
    EXPECT_NEAR(box[1].z() - box[0].z(), woman().truth.height("stature"), 0.004);  // ISO 20685
  }
}

TEST(Reconstruction, AFloorThatWasSeenIsTheGroundThoughHerFeetWereNot) {
  PointCloud scan;
  for (const Eigen::Vector3d& p : booth_scan().points)
    if (p.z() < 0.005 || p.z() > 0.14) scan.points.push_back(p);  // black socks
  const body_model::RegisteredBody model = test::reconstructed(scan, quick()).model;
  EXPECT_NEAR(model.ground, 0, 0.001);
  EXPECT_EQ(model.ground_deviation, 0);
}

TEST(Reconstruction, AFlatCutThroughHerIsNoFloor) {
  constexpr double kCut = 0.75;  // m, through her thighs
  PointCloud scan;
  for (const Eigen::Vector3d& p : scan_of(100000, kNoise, false).points)
    if (p.z() > kCut) scan.points.push_back(p);
  for (double x = -0.2; x < 0.2;
       x += 0.005)  // as software that fills holes, or a table behind which she stands
    for (double y = -0.25; y < 0.25; y += 0.005) scan.points.emplace_back(x, y, kCut);
  const body_model::RegisteredBody model = test::reconstructed(scan, quick()).model;
  EXPECT_NEAR(model.ground, 0, 0.07);  // three deviations of soles that nothing shows
  EXPECT_GT(model.ground_deviation, 0.005);
}

TEST(Reconstruction, AFootThatIsLiftedIsNoPlate) {
  constexpr double kKnee = 0.45, kLift = 0.1;  // m
  PointCloud scan = booth_scan();
  for (Eigen::Vector3d& p : scan.points)  // her left leg, shortened up to the knee; she stands on y = 0
    if (p.y() > 0 && p.y() < 0.25 && p.z() > 0.005 && p.z() < kKnee)
      p.z() = kKnee - (kKnee - p.z()) * (kKnee - kLift) / kKnee;
  EXPECT_NEAR(test::reconstructed(scan, quick()).model.ground, 0, 0.001);
}

TEST(Reconstruction, WithoutAFloorTheSolesLieBelowTheLowestPoints) {
  const reconstruction::Reconstruction result = test::reconstructed(scan_of(100000, kNoise, false), quick());
  expect_sound(result.body, kTriangles);
  EXPECT_NEAR(geometry::bounding_box(result.body.mesh.vertices)[0].z(), 0,
              0.004);  // ISO 20685: it shifts each height
  EXPECT_NEAR(result.model.ground, 0, 0.004);
  EXPECT_EQ(result.model.ground_deviation, body_model::shipped_registrar().standing().ground);
  EXPECT_GT(result.model.vertical.z(), std::cos(1 * M_PI / 180));
}

TEST(Reconstruction, TiltTurnAndFarOriginDoNotMatter) {
  const Eigen::Isometry3d pose = Eigen::Translation3d(1e6, -2e6, 3e5) *
                                 Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 1, 0).normalized()) *
                                 Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ());
  const auto moved = map(booth_scan(), [&](const Eigen::Vector3d& p) { return pose * p; });
  const reconstruction::Reconstruction result = test::reconstructed(moved, quick());
  expect_sound(result.body, kTriangles);
  const std::vector<double> error = errors(result.body, pose.inverse());
  EXPECT_LT(percentile(error, 0.5), 0.0005);
  EXPECT_LT(percentile(error, 0.95), 0.0015);
  for (const char* point :
       {"bust_point_L", "crotch", "navel"})  // on the model's skin, which follows the samples
    EXPECT_LT((pose.inverse() * result.model.skin_point(point) - her().model.skin_point(point)).norm(), 0.002)
        << point;
  EXPECT_GT(result.model.vertical.dot(pose.linear().col(2)), std::cos(0.2 * M_PI / 180));
}

TEST(Reconstruction, GivenNormalsAndPointsThatAreNotFiniteAreCopedWith) {
  PointCloud scan = scan_of(100000, kNoise, false);
  for (const Eigen::Vector3d& p : scan.points) {
    const Eigen::Vector3i& t = woman().mesh.triangles[skin().nearest(p).triangle];
    const auto& v = woman().mesh.vertices;
    scan.normals.push_back(geometry::area_vector(v[t[0]], v[t[1]], v[t[2]]).normalized());
  }
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (i % 100 == 0) scan.normals[i] = -scan.normals[i];
    if (i % 100 == 1) scan.normals[i].setConstant(std::numeric_limits<double>::quiet_NaN());
    if (i % 7 == 0) scan.points[i].x() = std::numeric_limits<double>::infinity();
    if (i % 11 == 0) scan.points[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const Eigen::Vector3d nothing = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  scan.points.resize(3 * scan.points.size(), nothing);  // as a depth image that she fills a third of
  scan.normals.resize(scan.points.size(), nothing);
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, kTriangles);
  EXPECT_LT(percentile(errors(body), 0.5), 0.0005);
}

TEST(Reconstruction, AHoleIsClosedAlongTheModelsSkinAndReported) {
  const Eigen::Vector3d navel = woman().truth.landmark("navel");
  constexpr double kRadius = 0.04;
  PointCloud scan = booth_scan();
  auto& points = scan.points;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Eigen::Vector3d& p) { return (p - navel).norm() < kRadius; }),
               points.end());
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, kTriangles);
  // What is farther inside than `support_distance` counts as filled; points are some 4 mm apart, hence the
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
    const double off = (body.mesh.vertices[v] - navel).norm();
    if (off < 0.02) {
      EXPECT_TRUE(body.filled[v]);
      EXPECT_LT(distance(body.mesh.vertices[v]),
                0.004);  // 40 mm over a belly of 0.15 m: 5 mm of sag without a model
    }
    if (off > 0.05 && off < 0.10) {
      ++beside;
      filled_beside += body.filled[v];
    }
  }
  EXPECT_LT(filled_beside, 0.03 * beside);
}

TEST(Reconstruction, UnseenSkinIsTheModelsWhereNothingElseIsNear) {
  const body_model::RegisteredBody& model = her().model;
  const body_model::Samples all = body_model::sample_surface({model.skin, model.model->triangles}, {}, 60000);
  PointCloud seen;
  const Eigen::Vector3d tip = model.skin_point("bust_point_L");
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if ((all.points[i] - tip).norm() < 0.04 || all.points[i].z() > 1.0 * model.stature()) continue;
    seen.points.push_back(all.points[i]);
    seen.normals.push_back(all.normals[i]);
  }
  const PointCloud unseen = reconstruction::unseen_skin(model, seen);
  std::size_t in_hole = 0, on_hands = 0;
  const geometry::TriangleMesh mesh{model.skin, model.model->triangles};
  const geometry::SurfaceTree own(mesh);
  for (std::size_t i = 0; i < unseen.points.size(); ++i) {
    EXPECT_NEAR(unseen.normals[i].norm(), 1, 1e-9);
    EXPECT_LT((own.nearest(unseen.points[i]).position - unseen.points[i]).norm(), 1e-6);
    in_hole += (unseen.points[i] - tip).norm() < 0.05;
    const int corner = mesh.triangles[own.nearest(unseen.points[i]).triangle][0];
    on_hands += model.model->parts[model.model->part[corner]].rfind("hand", 0) == 0;
  }
  // A disc of 40 mm, but for its rim of 8 mm, at a point in 4 mm by 4 mm.
  EXPECT_GT(in_hole, 0.7 * M_PI * 0.032 * 0.032 / (0.004 * 0.004));
  EXPECT_EQ(on_hands, 0u);
  EXPECT_LT(unseen.points.size() - in_hole, 0.02 * all.points.size());  // the rest of her was seen
}

TEST(Reconstruction, WhatTheBodyModelRefusesIsRefused) {
  const auto refuse = [](const body_model::Samples&) -> body_model::RegisteredBody {
    throw geometry::Refusal("not_a_body", "a mannequin");
  };
  try {
    reconstruction::reconstruct(booth_scan(), quick(), {refuse, body_model::shipped_registrar().standing()});
    ADD_FAILURE() << "accepted";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "not_a_body");
  }
}

TEST(Reconstruction, NoisyPointsGiveASurfaceFinerThanTheirNoise) {
  const BodyMesh body = reconstruct(scan_of(100000, 0.0015, true), quick());
  expect_sound(body, kTriangles);
  const std::vector<double> error = errors(body);
  EXPECT_LT(percentile(error, 0.5), 0.0007);  // the mean of some eight points of 1.5 mm noise
  EXPECT_LT(percentile(error, 0.95), 0.0020);
}

TEST(Reconstruction, DuplicatesCountOnce) {
  PointCloud scan = booth_scan();
  for (int copy = 1; copy < 8; ++copy)
    scan.points.insert(scan.points.end(), booth_scan().points.begin(), booth_scan().points.end());
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, kTriangles);
  EXPECT_NEAR(static_cast<double>(body.points_used), her().body.points_used, 0.001 * her().body.points_used);
  EXPECT_LT(percentile(errors(body), 0.95), 0.0015);
}

TEST(Reconstruction, AScanDenserThanHelpsIsThinned) {
  const BodyMesh body = reconstruct(scan_of(900000, 0.001, true), quick());
  expect_sound(body, kTriangles);
  EXPECT_LT(body.points_used, 400000u);  // as many points as time and memory are meant for
  EXPECT_LT(percentile(errors(body), 0.5), 0.0005);
}

TEST(Reconstruction, ThirtyPercentOfStrayPointsDoNotMatter) {
  PointCloud scan = booth_scan();
  std::mt19937 random(6);
  for (int i = 0; i < 43000; ++i)  // of 143,000
    scan.points.emplace_back(1.6 * figure::uniform(random) - 0.8, 1.6 * figure::uniform(random) - 0.8,
                             1.8 * figure::uniform(random));
  const BodyMesh body = reconstruct(scan, quick());
  expect_sound(body, kTriangles);
  EXPECT_LT(percentile(errors(body), 0.5), 0.0005);
}

TEST(Reconstruction, SameScanSameMeshEvenTwoAtOnce) {
  const PointCloud& scan = booth_scan();  // made by one thread
  reconstruction::Reconstruction second, third;
  std::thread other([&] { second = test::reconstructed(scan, quick()); });
  third = test::reconstructed(scan, quick());
  other.join();
  for (const auto* result : {&second, &third}) {
    EXPECT_EQ(result->body.mesh.vertices, her().body.mesh.vertices);
    EXPECT_EQ(result->body.mesh.triangles, her().body.mesh.triangles);
    EXPECT_EQ(result->body.filled, her().body.filled);
    EXPECT_EQ(result->model.skin, her().model.skin);
  }
}

TEST(Reconstruction, RefusesByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal_of({}), "empty_cloud");
  EXPECT_EQ(refusal_of(map(booth_scan(), [&](const auto&) { return Eigen::Vector3d(nan, nan, nan); })),
            "non_finite");
  EXPECT_EQ(refusal_of(figure::scan_body(1000, 0, 1)), "too_few_points");
  PointCloud repeated;
  for (int i = 0; i < 20; ++i) {
    const PointCloud once = figure::scan_body(1000, 0, 1);
    repeated.points.insert(repeated.points.end(), once.points.begin(), once.points.end());
  }
  EXPECT_EQ(refusal_of(repeated), "too_few_points");
  EXPECT_EQ(refusal_of(map(booth_scan(), [](const auto& p) { return Eigen::Vector3d(1000 * p); })),
            "wrong_unit");
  EXPECT_EQ(refusal_of(map(booth_scan(), [](const auto& p) { return Eigen::Vector3d(39.37 * p); })),
            "wrong_unit");
  EXPECT_EQ(refusal_of(map(booth_scan(), [](const auto& p) { return Eigen::Vector3d(0.001 * p); })),
            "wrong_unit");
  EXPECT_EQ(refusal_of(map(booth_scan(), [](const auto&) { return Eigen::Vector3d(1, 2, 3); })),
            "not_a_body");
  PointCloud far = figure::scan_body(6000, 0, 1);
  for (std::size_t i = 0; i < far.points.size(); i += 3) far.points[i].x() += 5;
  try {
    reconstruct(far, quick());
    ADD_FAILURE() << "accepted";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("within 4 m"), std::string::npos) << refusal.what();
  }
  PointCloud half = figure::scan_body(10000, 0, 1);
  half.normals.pop_back();
  EXPECT_EQ(refusal_of(half), "wrong_fields");
  Options small = quick();
  small.max_points = 10000;
  EXPECT_EQ(refusal_of(booth_scan(), small), "too_many_points");
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
  PointCloud dust;  // so sparse that each point is stray
  for (int i = 0; i < 8000; ++i)
    dust.points.emplace_back(4 * figure::uniform(random), 4 * figure::uniform(random),
                             2.5 * figure::uniform(random));
  EXPECT_EQ(refusal_of(dust), "not_a_body");
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
      reconstruct(booth_scan(), options);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code() + ": " + refusal.what();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(
      message_with([](Options& o) { o.body_triangles = 10; }).find("bad_option: option 'body_triangles'"),
      0u);
  EXPECT_EQ(message_with([](Options& o) { o.poisson_depth = 20; }).find("bad_option: option 'poisson_depth'"),
            0u);
  EXPECT_EQ(message_with([](Options& o) { o.min_points = -1; }).find("bad_option: option 'min_points'"), 0u);
  EXPECT_EQ(message_with([](Options& o) { o.max_points = 0; }).find("bad_option: option 'max_points'"), 0u);
  EXPECT_EQ(message_with([](Options& o) {
              o.support_distance = std::nan("");
            }).find("bad_option: option 'support_distance'"),
            0u);
}

}  // namespace
}  // namespace tensegric_fit
