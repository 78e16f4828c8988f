#include "body_model/registered_body.hpp"

#include <cmath>
#include <stdexcept>

namespace tensegric_fit::body_model {

Eigen::Vector3d skin_point(const Model& model, const std::vector<Eigen::Vector3d>& skin,
                           const std::string& name) {
  for (const SkinPoint& point : model.skin_points) {
    if (point.name != name) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [vertex, share] : point.vertices) sum += share * skin[vertex];
    return sum;
  }
  throw std::out_of_range("the body model has no skin point " + name);
}

Eigen::Vector3d RegisteredBody::skin_point(const std::string& name) const {
  return body_model::skin_point(*model, skin, name);
}
Eigen::Vector3d RegisteredBody::posed_point(const std::string& name) const {
  return body_model::skin_point(*model, posed, name);
}

Eigen::Vector3d RegisteredBody::bone_point(const std::string& name) const {
  for (std::size_t i = 0; i < bone_points.size(); ++i)
    if (model->bone_points[i].name == name) return bone_points[i];
  throw std::out_of_range("the body model has no bone point " + name);
}

Eigen::Vector3d RegisteredBody::joint(const std::string& name) const {
  for (std::size_t b = 0; b < joints.size(); ++b)
    if (model->bones[b].name == name) return joints[b];
  throw std::out_of_range("the body model has no bone " + name);
}

double RegisteredBody::stature() const {
  return std::exp(parameters.log_scale) * model->stature;
}

RegisteredBody moved(const RegisteredBody& body, const Eigen::Isometry3d& motion) {
  RegisteredBody result = body;
  for (auto* points : {&result.posed, &result.skin, &result.joints, &result.bone_points})
    for (Eigen::Vector3d& p : *points) p = motion * p;
  for (Unexplained& thing : result.unexplained) thing.centre = motion * thing.centre;
  result.parameters.rotation = motion.linear() * body.parameters.rotation;
  result.parameters.position = motion * body.parameters.position;
  result.vertical = motion.linear() * body.vertical;
  result.ground = body.ground + result.vertical.dot(motion.translation());
  return result;
}

}  // namespace tensegric_fit::body_model
