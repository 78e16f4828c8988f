#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"
#include "true_girth.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using virtual_body::BodyParameters;
using virtual_body::VirtualBody;

const VirtualBody& default_body() {
  static const VirtualBody body = virtual_body::make_body({});
  return body;
}

BodyParameters unlike_default() {
  BodyParameters parameters;
  parameters.stature = 1.58;
  parameters.bust = 1.2;
  parameters.firmness = 0.4;
  parameters.asymmetry = 0.15;
  parameters.waist = 1.15;
  parameters.hip = 1.08;
  parameters.arm_angle = 0.5;
  parameters.yaw = 2.2;
  parameters.tilt = 0.1;
  return parameters;
}

const VirtualBody& other_body() {
  static const VirtualBody body = virtual_body::make_body(unlike_default());
  return body;
}

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

double distance_to_mesh(const Vector3d& p, const geometry::TriangleMesh& mesh) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if ((p - a).norm() > nearest + 0.05) continue;  // no edge is that long
    const Vector3d n = geometry::area_vector(a, b, c).normalized();
    const bool above = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                       n.dot((a - c).cross(p - c)) >= 0;
    const double here = above ? std::abs(n.dot(p - a))
                              : std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c),
                                          distance_to_segment(p, c, a)});
    nearest = std::min(nearest, here);
  }
  return nearest;
}

void expect_one_closed_outward_surface(const geometry::TriangleMesh& mesh) {
  geometry::check_mesh(mesh);
  ASSERT_TRUE(geometry::is_closed(mesh));
  for (const int component : geometry::components_of(mesh)) ASSERT_EQ(component, 0);
  // A sphere's topology: no handle, nothing grown together that should be apart (legs, arms and trunk)
  const auto edges = static_cast<long>(geometry::edges_of(mesh).size());
  EXPECT_EQ(static_cast<long>(mesh.vertices.size()) - edges + static_cast<long>(mesh.triangles.size()), 2);
  // Outward, and the volume of a person: 1 kg is about a litre
  const double volume = geometry::cone_volume(mesh.vertices, mesh.triangles);
  EXPECT_GT(volume, 0.030);
  EXPECT_LT(volume, 0.120);
}

TEST(VirtualBodyTest, MeshIsClosedManifoldAndOutward) {
  expect_one_closed_outward_surface(default_body().mesh);
  EXPECT_GT(default_body().mesh.triangles.size(), 60000u);
  EXPECT_LT(default_body().mesh.triangles.size(), 120000u);
  expect_one_closed_outward_surface(other_body().mesh);
}

TEST(VirtualBodyTest, SymmetricBodyIsItsOwnMirrorImage) {
  std::set<std::tuple<double, double, double>> vertices;
  for (const Vector3d& p : default_body().mesh.vertices) vertices.emplace(p.x(), p.y(), p.z());
  for (const Vector3d& p : default_body().mesh.vertices) {
    const double mirrored = p.y() == 0 ? 0 : -p.y();
    ASSERT_EQ(vertices.count({p.x(), mirrored, p.z()}), 1u) << p.transpose();
  }
  for (const char* name : {"bust_point", "underbust", "shoulder", "axilla", "buttock", "neck_side"}) {
    const Vector3d left = default_body().truth.landmark(std::string(name) + "_L");
    const Vector3d right = default_body().truth.landmark(std::string(name) + "_R");
    EXPECT_LT((left - Vector3d(right.x(), -right.y(), right.z())).norm(), 1e-9) << name;
  }
}

TEST(VirtualBodyTest, SameParametersGiveTheSameBits) {
  const VirtualBody &a = other_body(), b = virtual_body::make_body(unlike_default());
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  for (std::size_t i = 0; i < a.truth.girths.size(); ++i)
    EXPECT_EQ(a.truth.girths[i].metres, b.truth.girths[i].metres) << a.truth.girths[i].name;
}

TEST(VirtualBodyTest, LandmarksLieOnTheSkin) {
  for (const VirtualBody& body : {default_body(), other_body()})
    for (const geometry::Landmark& landmark : body.truth.landmarks) {
      // The skin is exact, the triangles are its chords: the armpit's crease is as sharp as they are long
      // (6.5 mm), the fold of a soft breast nearly so.
      const bool crease = landmark.name.compare(0, 6, "axilla") == 0,
                 fold = landmark.name.compare(0, 4, "fold") == 0;
      const double chord = crease ? 0.0025 : fold ? 0.0015 : 0.001;
      EXPECT_LT(distance_to_mesh(landmark.position, body.mesh), chord) << landmark.name;
    }
}

TEST(VirtualBodyTest, MeasuresAreThoseOfAWoman) {
  const VirtualBody& body = default_body();
  // Ranges of sizes 34 to 44 (EN 13402-3), wide on purpose
  EXPECT_GT(true_girth(body, "bust"), 0.80);
  EXPECT_LT(true_girth(body, "bust"), 1.04);
  EXPECT_GT(true_girth(body, "bust"), true_girth(body, "underbust") + 0.10);
  EXPECT_GT(true_girth(body, "underbust"), true_girth(body, "waist"));
  EXPECT_GT(true_girth(body, "hip"), true_girth(body, "waist") + 0.15);
  EXPECT_NEAR(true_girth(body, "neck"), 0.31, 0.03);
  const geometry::BodyMeasures& truth = body.truth;
  EXPECT_NEAR(truth.height("stature"), 1.70, 0.001);
  EXPECT_NEAR(geometry::bounding_box(body.mesh.vertices)[0].z(), 0, 0.0005);  // soles, as far as chords go
  EXPECT_GT(truth.height("neck"), truth.height("bust"));
  EXPECT_GT(truth.height("bust"), truth.height("underbust") + 0.02);
  EXPECT_GT(truth.height("underbust"), truth.height("waist") + 0.015);
  EXPECT_GT(truth.height("waist"), truth.height("hip") + 0.10);
  EXPECT_GT(truth.height("hip"), truth.height("crotch"));
  EXPECT_EQ(body.waist_method.find("ruler"), std::string::npos);
}

TEST(VirtualBodyTest, MeasuresFollowTheParameters) {
  const VirtualBody& body = default_body();
  BodyParameters parameters;
  parameters.bust = 1.2;
  parameters.hip = 1.1;
  const VirtualBody full = virtual_body::make_body(parameters);
  EXPECT_GT(true_girth(full, "bust"), true_girth(body, "bust") + 0.01);
  EXPECT_NEAR(true_girth(full, "hip"), 1.1 * true_girth(body, "hip"), 0.01);
  parameters = {};
  parameters.waist = 1.1;
  parameters.firmness = 0.3;
  parameters.asymmetry = 0.2;
  const VirtualBody soft = virtual_body::make_body(parameters);
  const double at_navel = 1 + 0.1 * std::exp(-std::pow(0.030 / 0.085, 2));  // 30 mm below the waist
  EXPECT_NEAR(true_girth(soft, "waist_ruler"), at_navel * true_girth(body, "waist_ruler"), 0.01);
  EXPECT_LT(soft.truth.height("bust"), body.truth.height("bust") - 0.01);
  EXPECT_GT(soft.truth.landmark("bust_point_L").x(), soft.truth.landmark("bust_point_R").x() + 0.005);
  parameters = {};
  parameters.stature = 1.55;
  const VirtualBody small = virtual_body::make_body(parameters);
  for (const char* name : {"bust", "hip", "thigh_L"})  // the whole body scales; the grid with it
    EXPECT_NEAR(true_girth(small, name), true_girth(body, name) * 1.55 / 1.70, 1e-5) << name;
  EXPECT_NEAR(true_girth(small, "neck"), true_girth(body, "neck") * 1.55 / 1.70,
              1e-4);  // the levels it is looked for on do not
}

TEST(VirtualBodyTest, NeckGirthIsTheLeastAndShouldersDoNotMoveOutWithFat) {
  const auto bone_breadth = [](const VirtualBody& body) {
    return body.truth.landmark("shoulder_L").y() - body.truth.landmark("shoulder_R").y();
  };
  BodyParameters parameters;
  parameters.arm_angle = 0.5;
  const VirtualBody slim = virtual_body::make_body(parameters);
  parameters.build = 1.4;
  const VirtualBody heavy = virtual_body::make_body(parameters);
  EXPECT_NEAR(bone_breadth(heavy), bone_breadth(slim), 1e-9);
  EXPECT_GT(heavy.truth.landmark("shoulder_L").z(),
            slim.truth.landmark("shoulder_L").z());  // straight up, through more flesh
  for (const VirtualBody* body : {&slim, &heavy}) {
    double tape_height = 0;
    for (const geometry::GirthLoop& loop : body->truth.loops)
      if (loop.name == "neck")
        for (const Vector3d& p : loop.points) tape_height += p.z() / static_cast<double>(loop.points.size());
    EXPECT_GT(tape_height, body->truth.height("neck") - 0.002);  // on the base's plane or above it
    EXPECT_LT(tape_height, body->truth.height("neck") + 0.042);
  }
}

TEST(VirtualBodyTest, AFullWaistHasNoMinimumAndIsMeasuredAtTheNavel) {
  BodyParameters parameters;
  parameters.waist = 1.4;
  const VirtualBody body = virtual_body::make_body(parameters);
  EXPECT_NE(body.waist_method.find("ruler"), std::string::npos);
  EXPECT_EQ(body.truth.height("waist"), body.truth.height("waist_ruler"));
  for (const char* name : {"girth waist", "height waist"})
    EXPECT_EQ(std::count(body.doubts.vague.begin(), body.doubts.vague.end(), name), 1) << name;
}

TEST(VirtualBodyTest, PoseMovesTheBodyAndNotItsMeasures) {
  const VirtualBody& posed = other_body();
  BodyParameters parameters = unlike_default();
  parameters.yaw = parameters.tilt = 0;
  const VirtualBody upright = virtual_body::make_body(parameters);
  double lowest = 1;
  for (const Vector3d& p : posed.mesh.vertices) lowest = std::min(lowest, p.z());
  EXPECT_NEAR(lowest, 0, 1e-12);  // on the floor
  for (const geometry::Landmark& landmark : upright.truth.landmarks) {
    const Vector3d back = posed.truth.body_from_scan * posed.truth.landmark(landmark.name);
    EXPECT_LT((back - landmark.position).norm(), 1e-12) << landmark.name;
  }
  EXPECT_EQ(true_girth(posed, "bust"), true_girth(upright, "bust"));
  // She faces where yaw says
  const Vector3d forward = posed.truth.body_from_scan.inverse().linear().col(0);
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 2.2, 1e-12);
}

TEST(VirtualBodyTest, ParametersOutOfRangeAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_refused = [](double BodyParameters::*field, double value, const std::string& name) {
    BodyParameters parameters;
    parameters.*field = value;
    try {
      virtual_body::make_body(parameters);
      ADD_FAILURE() << name << " accepted";
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), geometry::refusal::kBadOption);
      EXPECT_NE(std::string(refusal.what()).find("'" + name + "'"), std::string::npos) << refusal.what();
    }
  };
  expect_refused(&BodyParameters::stature, 170, "stature");
  expect_refused(&BodyParameters::bust, nan, "bust");
  expect_refused(&BodyParameters::firmness, -1, "firmness");
  expect_refused(&BodyParameters::build, 2, "build");
  expect_refused(&BodyParameters::belly, -0.1, "belly");
  expect_refused(&BodyParameters::stoop, 0.5, "stoop");
  expect_refused(&BodyParameters::asymmetry, 1, "asymmetry");
  expect_refused(&BodyParameters::waist, 0, "waist");
  expect_refused(&BodyParameters::hip, 2, "hip");
  expect_refused(&BodyParameters::arm_angle, 1.6, "arm_angle");
  expect_refused(&BodyParameters::yaw, 4, "yaw");
  expect_refused(&BodyParameters::tilt, 0.5, "tilt");
}

}  // namespace
}  // namespace tensegric_fit
