#include "virtual_body/model_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/range.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "virtual_body/model_landmarks.hpp"
#include "virtual_body/scan_pose.hpp"
#include "virtual_body/skin_measures.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using body_model::Model;
using Eigen::Vector3d;

constexpr double kFarthestShape = 4;  // deviations; of independent normal numbers one in 16,000 lies beyond

/// A joint of the model's shape at rest.
Vector3d joint_at_rest(const Model& model, const Eigen::VectorXd& shape, const std::string& name) {
  const int bone = bone_named(model, name);
  return model.inner_mean[bone] + model.inner_basis.middleCols<3>(3 * bone).transpose() * shape;
}

/// Turns of one arm's pose groups. At rest the upper arm is held out and the elbow bent; about the model's
/// axes turns by x go backwards (arms) and forwards (trunk), by y to her right.
void pose_arm(const Model& model, const ModelBodyParameters& wanted, Side side,
              body_model::Parameters& pose) {
  const std::string suffix = std::string(".") + (side == kLeft ? "L" : "R");
  const auto at_rest = [&](const char* name) { return joint_at_rest(model, pose.shape, name + suffix); };
  const Vector3d upper = at_rest("lowerarm01") - at_rest("upperarm01"),
                 fore = at_rest("wrist") - at_rest("lowerarm01");
  const double held_out = std::atan2(kSign[side] * upper.x(), -upper.z()),
               bent = std::atan2(upper.cross(fore).norm(), upper.dot(fore));
  pose.turns[model.group_named(std::string("arm") + kSuffix[side])] =
      Vector3d(-wanted.forwards[side], -kSign[side] * (wanted.arms[side] - held_out), 0);
  pose.turns[model.group_named(std::string("forearm") + kSuffix[side])].x() = bent - wanted.elbows[side];
}

body_model::Parameters posed(const Model& model, const ModelBodyParameters& wanted) {
  body_model::Parameters pose(model);
  if (wanted.shape.size() > 0) pose.shape = wanted.shape;
  pose.log_scale = std::log(wanted.stature / model.stature);
  pose.rotation =
      Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();  // from facing -y to facing x
  for (const Side side : kSides) {
    pose_arm(model, wanted, side, pose);
    const double out = -kSign[side] * wanted.legs;
    pose.turns[model.group_named(std::string("thigh") + kSuffix[side])].y() = out;
    pose.turns[model.group_named(std::string("foot") + kSuffix[side])].y() = -out;
  }
  // Five vertebrae turn alike, two of them in the lower group.
  const Vector3d chest(wanted.lean, -wanted.bend, wanted.twist);
  pose.turns[model.group_named("spine_low")] = 0.4 * chest;
  pose.turns[model.group_named("spine_high")] = 0.6 * chest;
  return pose;
}

double lowest(const std::vector<Vector3d>& vertices) {
  return geometry::bounding_box(vertices)[0].z();
}

}  // namespace

void check_parameters(const ModelBodyParameters& p) {
  const auto check = geometry::check_option;
  for (Eigen::Index k = 0; k < p.shape.size(); ++k)
    check(fmt::format("shape[{}]", k), p.shape[k], {-kFarthestShape, kFarthestShape});
  check("stature", p.stature, {1.40, 2.00});
  for (const Side side : kSides) {
    check(std::string("arm_angle") + kSuffix[side], p.arms[side], {0.17, 1.05});
    check(std::string("arm_forwards") + kSuffix[side], p.forwards[side], {-0.5, 0.5});
    check(std::string("elbow") + kSuffix[side], p.elbows[side], {0, 1});
  }
  check("legs", p.legs, {-0.15, 0.30});
  check("lean", p.lean, {-0.2, 0.4});
  check("bend", p.bend, {-0.2, 0.2});
  check("twist", p.twist, {-0.2, 0.2});
  check("yaw", p.yaw, {-M_PI, M_PI});
  check("tilt", p.tilt, {-0.26, 0.26});
}

StandingModel stand(const Model& model, const ModelBodyParameters& parameters) {
  StandingModel standing{posed(model, parameters), {}};
  const body_model::PosedModel raised(model, standing.parameters);
  const Vector3d feet =
      (raised.joint(bone_named(model, "foot.L")) + raised.joint(bone_named(model, "foot.R"))) / 2;
  standing.parameters.position -= Vector3d(feet.x(), feet.y(), lowest(raised.vertices()));
  standing.vertices = body_model::PosedModel(model, standing.parameters).vertices();
  return standing;
}

VirtualBody make_body(const Model& model, const ModelBodyParameters& parameters, int subdivisions) {
  check_parameters(parameters);
  if (parameters.shape.size() > 0 && parameters.shape.size() != model.components())
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            fmt::format("the shape has {} numbers; the body model has {}",
                                        parameters.shape.size(), model.components()));
  StandingModel standing = stand(model, parameters);
  std::vector<double> arm = model.arm;
  std::vector<Quad> quads = model.quads;
  for (int step = 0; step < subdivisions; ++step) {
    const CatmullClark finer(standing.vertices.size(), quads);
    standing.vertices = finer.refined(standing.vertices);
    arm = finer.refined(arm);
    quads = finer.quads();
  }
  // Smooth soles end a little higher than the coarse ones.
  const Vector3d down = -lowest(standing.vertices) * Vector3d::UnitZ();
  for (Vector3d& p : standing.vertices) p += down;
  standing.parameters.position += down;

  VirtualBody body;
  body.family = "model";
  body.mesh = {standing.vertices, triangles_of(quads)};
  const Collisions collided = collisions(model, stand(model, parameters).vertices);
  if (collided.arms[kLeft] || collided.arms[kRight])
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "with these body parameters an arm runs into the body; raise 'arm_angle'");
  measure_model_body(model, standing.parameters, Skin(body.mesh, arm), body);
  body.parameters = {{"stature", parameters.stature},
                     {"arm_angle_L", parameters.arms[kLeft]},
                     {"arm_angle_R", parameters.arms[kRight]},
                     {"arm_forwards_L", parameters.forwards[kLeft]},
                     {"arm_forwards_R", parameters.forwards[kRight]},
                     {"elbow_L", parameters.elbows[kLeft]},
                     {"elbow_R", parameters.elbows[kRight]},
                     {"legs", parameters.legs},
                     {"lean", parameters.lean},
                     {"bend", parameters.bend},
                     {"twist", parameters.twist},
                     {"yaw", parameters.yaw},
                     {"tilt", parameters.tilt}};
  body.shape.assign(parameters.shape.data(), parameters.shape.data() + parameters.shape.size());
  place_in_scan(parameters.yaw, parameters.tilt, body);
  return body;
}

int bone_named(const Model& model, const std::string& name) {
  for (std::size_t b = 0; b < model.bones.size(); ++b)
    if (model.bones[b].name == name) return static_cast<int>(b);
  throw std::out_of_range("the body model has no bone " + name);
}

const Model& shipped_model() {
  static const Model model = body_model::load_model(geometry::shipped_folder("body_model") + "/women.tfb");
  return model;
}

}  // namespace tensegric_fit::virtual_body
