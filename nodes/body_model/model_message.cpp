#include "body_model/model_message.hpp"

#include <algorithm>
#include <cmath>

#include "body_model/matching.hpp"
#include "body_model/missing_parts.hpp"
#include "body_model/parts.hpp"
#include "geometry/status.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::node {
namespace {

using body_model::RegisteredBody;
using geometry::Refusal;

constexpr double kUnit = 1e-6;  // of a length that is one
// Numerical tolerances, far beyond what a registration finds: numbers outside them overflow, or ask for
// memory by the size of a body that nobody has.
constexpr double kLeastResidual = 1e-6;  // m
constexpr double kLargestScale = 10, kLargestShape = 100;

void check(bool holds, const std::string& what) {
  if (!holds) throw Refusal(geometry::refusal::kBadModel, "body model: " + what);
}

template <typename Numbers>
void check_finite(const Numbers& numbers, const std::string& what) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); }))
    throw Refusal(geometry::refusal::kNonFinite, "body model: " + what + " is not finite");
}

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& named) {
  std::vector<std::string> names;
  for (const Named& one : named) names.push_back(one.name);
  return names;
}

void check_numbers(const BodyModel& message) {
  check_finite(message.turns, "turns");
  check_finite(message.shape, "shape");
  check_finite(message.off, "off");
  check_finite(message.support, "support");
  check_finite(message.rotation, "rotation");
  check_finite(message.position, "position");
  check_finite(message.up, "up");
  check_finite(std::initializer_list<double>{message.residual, message.ground, message.ground_deviation,
                                             message.scale},
               "residual, ground, its deviation or scale");
}

void check_ranges(const BodyModel& message) {
  check(message.residual > kLeastResidual && message.residual <= body_model::Matching::kUnmatched,
        "its residual is none of a registration");
  check(message.ground_deviation >= 0 && message.ground_deviation <= kFarthest,
        "its ground has no deviation that can be");
  check(std::max(std::abs(message.ground),
                 Eigen::Vector3d::Map(message.position.data()).cwiseAbs().maxCoeff()) <= kFarthest,
        "it is 10,000 km away");
  for (const auto* distances : {&message.off, &message.support})
    check(*std::min_element(distances->begin(), distances->end()) >= 0, "a distance is below 0");
  check(std::abs(Eigen::Vector3d::Map(message.up.data()).norm() - 1) < kUnit, "its `up` is no unit vector");
}

void check_sizes(const BodyModel& message, const body_model::Model& model) {
  const std::size_t skin = model.mean.size();
  check(message.pose_groups == names_of(model.groups) && message.turns.size() == 3 * model.groups.size(),
        "its turns are not those of the model's pose groups");
  check(message.shape.size() == static_cast<std::size_t>(model.components()),
        "its shape has another number of coefficients than the model");
  check(message.vertices.size() == 3 * skin && message.off.size() == skin && message.support.size() == skin,
        "its skin has another number of vertices than the model's");
  check(message.bones == names_of(model.bones) && message.joints.size() == 3 * model.bones.size(),
        "its joints are not those of the model's bones");
  check(message.bone_point_names == names_of(model.bone_points) &&
            message.bone_points.size() == 3 * model.bone_points.size(),
        "its bone points are not the model's");
}

body_model::Parameters parameters_in(const BodyModel& message, const body_model::Model& model) {
  body_model::Parameters parameters(model);
  parameters.rotation =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.rotation.data());
  parameters.position = Eigen::Vector3d::Map(message.position.data());
  check(parameters.rotation.isUnitary(kUnit) && parameters.rotation.determinant() > 0,
        "its matrix is not a rotation");
  check(message.scale > 1 / kLargestScale && message.scale < kLargestScale, "its scale is no person's");
  parameters.log_scale = std::log(message.scale);
  parameters.turns = points_in(message.turns);
  parameters.shape =
      Eigen::VectorXd::Map(message.shape.data(), static_cast<Eigen::Index>(message.shape.size()));
  check(parameters.shape.norm() < kLargestShape, "its shape is no person's");
  return parameters;
}

}  // namespace

BodyModel to_message(const ScanTag& tag, const RegisteredBody& body,
                     const std::vector<unsigned char>& mesh_parts) {
  const body_model::Model& model = *body.model;
  const body_model::Parameters& parameters = body.parameters;
  BodyModel message;
  message.header = tag.header;
  message.scan_id = tag.scan_id;
  message.model = model.checksum;
  message.scanned = body.scanned;
  message.residual = body.residual;
  message.stature = body.stature();
  Eigen::Vector3d::Map(message.up.data()) = body.vertical;
  message.ground = body.ground;
  message.ground_deviation = body.ground_deviation;
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(message.rotation.data()) = parameters.rotation;
  Eigen::Vector3d::Map(message.position.data()) = parameters.position;
  message.scale = std::exp(parameters.log_scale);
  message.pose_groups = names_of(model.groups);
  message.turns = flat<double>(parameters.turns);
  message.shape.assign(parameters.shape.begin(), parameters.shape.end());
  message.vertices = flat<float>(body.skin);
  for (const std::array<int, 4>& quad : model.quads)
    message.quads.insert(message.quads.end(), quad.begin(), quad.end());
  message.off.assign(body.off.begin(), body.off.end());
  message.support.assign(body.support.begin(), body.support.end());
  message.bones = names_of(model.bones);
  message.joints = flat<double>(body.joints);
  message.bone_point_names = names_of(model.bone_points);
  message.bone_points = flat<double>(body.bone_points);
  message.parts = model.parts;
  message.skin_parts = model.part;
  message.mesh_parts = mesh_parts;
  return message;
}

RegisteredBody registered_in(const BodyModel& message,
                             const std::shared_ptr<const body_model::Model>& model) {
  if (message.model != model->checksum)
    throw Refusal(geometry::refusal::kOtherModel, "body model: registered with model file '" + message.model +
                                                      "', this build has '" + model->checksum +
                                                      "'; send the scan anew, or its mesh alone");
  check_sizes(message, *model);
  check_numbers(message);
  check_ranges(message);
  RegisteredBody body;
  body.model = model;
  body.parameters = parameters_in(message, *model);
  body.residual = message.residual;
  body.posed = body_model::PosedModel(*model, body.parameters).vertices();
  body.skin = points_in(message.vertices);
  body.off.assign(message.off.begin(), message.off.end());
  body.support.assign(message.support.begin(), message.support.end());
  body.joints = points_in(message.joints);
  body.bone_points = points_in(message.bone_points);
  body.scanned = message.scanned != 0;
  body.vertical = Eigen::Vector3d::Map(message.up.data());
  body.ground = message.ground;
  body.ground_deviation = message.ground_deviation;
  body.there = body_model::shares_there(body);
  return body;
}

void check_mesh_parts(const BodyModel& message, std::size_t vertices) {
  check(message.mesh_parts.size() == vertices, "it has not one part per vertex of the body mesh");
  for (const std::uint8_t part : message.mesh_parts)
    check(part < message.parts.size() || part == body_model::kUnknownPart,
          "a part of the body mesh has no name");
}

}  // namespace tensegric_fit::node
