#include "virtual_body/virtual_body.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/range.hpp"
#include "geometry/status.hpp"
#include "virtual_body/body_landmarks.hpp"
#include "virtual_body/body_shape.hpp"
#include "virtual_body/polygonise.hpp"
#include "virtual_body/scan_pose.hpp"
#include "virtual_body/skin_measures.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

constexpr double kGridSpacing = 0.0065;  // on the reference body; scales with the stature

// Legs, trunk and arms apart: closed and of one piece, V - E + F is 2 for a sphere and E is 3/2 F.
void check_apart(const geometry::TriangleMesh& mesh) {
  if (mesh.vertices.size() == mesh.triangles.size() / 2 + 2) return;
  throw geometry::Refusal(geometry::refusal::kBadOption,
                          "with these body parameters limbs grow into the trunk; raise 'arm_angle'");
}

BodyAxes axes_of(const BodyShape& shape, const geometry::BodyMeasures& truth) {
  BodyAxes axes;
  axes.neck = shape.neck_axis();
  for (const Side side : kSides) {
    axes.upper_arms[side] = shape.upper_arm_axis(side == kLeft);
    // The thighbone runs forward as it goes down.
    axes.thighs[side] = {Vector3d(shape.scaled(0.05), kSign[side] * shape.posed({0, 0.096, 0.73}).y(),
                                  truth.landmark("crotch").z() - shape.scaled(0.066)),
                         Vector3d(-0.12, 0, 1).normalized()};
  }
  axes.scale = shape.scaled(1);
  return axes;
}

}  // namespace

void check_parameters(const BodyParameters& parameters) {
  geometry::check_option("stature", parameters.stature, {1.40, 2.00});
  geometry::check_option("build", parameters.build, {0.85, 1.50});
  geometry::check_option("bust", parameters.bust, {0.75, 1.50});
  geometry::check_option("firmness", parameters.firmness, {-0.8, 1});
  geometry::check_option("asymmetry", parameters.asymmetry, {-0.2, 0.2});
  geometry::check_option("waist", parameters.waist, {0.90, 1.40});
  geometry::check_option("belly", parameters.belly, {0, 1});
  geometry::check_option("hip", parameters.hip, {0.90, 1.25});
  geometry::check_option("arm_angle", parameters.arm_angle, {0.25, 1.40});
  geometry::check_option("stoop", parameters.stoop, {-0.1, 0.4});
  geometry::check_option("yaw", parameters.yaw, {-M_PI, M_PI});
  geometry::check_option("tilt", parameters.tilt, {-0.26, 0.26});
}

VirtualBody make_body(const BodyParameters& parameters) {
  check_parameters(parameters);
  const BodyShape shape(parameters);
  VirtualBody body;
  body.family = "implicit";
  body.mesh = polygonise(shape, shape.scaled(kGridSpacing));
  check_apart(body.mesh);
  body.truth.landmarks = find_body_landmarks(shape);
  std::vector<double> arm;
  for (const Vector3d& p : body.mesh.vertices) arm.push_back(shape.is_arm(p));
  measure_skin(Skin(body.mesh, arm), axes_of(shape, body.truth), body);
  // Skin that is made without bones shows no acromion: where it is was chosen, and nobody could find it.
  for (const char* name : {"point shoulder_L", "point shoulder_R"})
    if (std::count(body.doubts.vague.begin(), body.doubts.vague.end(), name) == 0)
      body.doubts.vague.push_back(name);
  body.parameters = {
      {"stature", parameters.stature},     {"build", parameters.build}, {"bust", parameters.bust},
      {"firmness", parameters.firmness},   {"waist", parameters.waist}, {"asymmetry", parameters.asymmetry},
      {"belly", parameters.belly},         {"hip", parameters.hip},     {"stoop", parameters.stoop},
      {"arm_angle", parameters.arm_angle}, {"yaw", parameters.yaw},     {"tilt", parameters.tilt}};
  place_in_scan(parameters.yaw, parameters.tilt, body);
  return body;
}

}  // namespace tensegric_fit::virtual_body
