#include "booth/virtual_body.hpp"

#include <fmt/format.h>

#include <cmath>

#include "booth/body_girths.hpp"
#include "booth/body_landmarks.hpp"
#include "booth/body_shape.hpp"
#include "booth/polygonise.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::booth {
namespace {

using Eigen::Vector3d;

constexpr double kGridSpacing = 0.0065;  // on the reference body; scales with the stature

void check(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;  // false for NaN
  throw geometry::Refusal(
      geometry::refusal::kBadOption,
      fmt::format("body parameter '{}' is {}; it must lie in [{}, {}]", name, value, low, high));
}

// She turns and leans about the origin and keeps her lowest point on the floor.
Eigen::Isometry3d pose(const BodyParameters& parameters, const geometry::TriangleMesh& mesh) {
  Eigen::Isometry3d scan_from_body = Eigen::Isometry3d::Identity();
  scan_from_body.linear() = (Eigen::AngleAxisd(parameters.yaw, Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(parameters.tilt, Vector3d::UnitY()))
                                .toRotationMatrix();
  if (parameters.tilt != 0) {
    double lowest = 0;
    for (const Vector3d& p : mesh.vertices) lowest = std::min(lowest, (scan_from_body * p).z());
    scan_from_body.translation().z() = -lowest;
  }
  return scan_from_body;
}

// Legs, trunk and arms apart: closed and of one piece, V - E + F is 2 for a sphere and E is 3/2 F.
void check_apart(const geometry::TriangleMesh& mesh) {
  if (mesh.vertices.size() == mesh.triangles.size() / 2 + 2) return;
  throw geometry::Refusal(geometry::refusal::kBadOption,
                          "with these body parameters limbs grow into the trunk; raise 'arm_angle'");
}

}  // namespace

void check_parameters(const BodyParameters& parameters) {
  check("stature", parameters.stature, 1.40, 2.00);
  check("build", parameters.build, 0.85, 1.50);
  check("bust", parameters.bust, 0.75, 1.50);
  check("firmness", parameters.firmness, -0.8, 1);
  check("asymmetry", parameters.asymmetry, -0.2, 0.2);
  check("waist", parameters.waist, 0.90, 1.40);
  check("belly", parameters.belly, 0, 1);
  check("hip", parameters.hip, 0.90, 1.25);
  check("arm_angle", parameters.arm_angle, 0.25, 1.40);
  check("stoop", parameters.stoop, -0.1, 0.4);
  check("yaw", parameters.yaw, -M_PI, M_PI);
  check("tilt", parameters.tilt, -0.26, 0.26);
}

VirtualBody make_body(const BodyParameters& parameters) {
  check_parameters(parameters);
  const BodyShape shape(parameters);
  VirtualBody body;
  body.mesh = polygonise(shape, shape.scaled(kGridSpacing));
  check_apart(body.mesh);
  body.truth.landmarks = find_body_landmarks(shape);
  body.waist_method = measure_girths(shape, body.mesh, body.truth);

  const Eigen::Isometry3d scan_from_body = pose(parameters, body.mesh);
  body.truth.body_from_scan = scan_from_body.inverse();
  for (Vector3d& p : body.mesh.vertices) p = scan_from_body * p;
  for (geometry::Landmark& landmark : body.truth.landmarks)
    landmark.position = scan_from_body * landmark.position;
  for (geometry::GirthLoop& loop : body.truth.loops)
    for (Vector3d& p : loop.points) p = scan_from_body * p;
  return body;
}

}  // namespace tensegric_fit::booth
