#include "landmarks/body_frame.hpp"

#include "body_model/recognition.hpp"

namespace tensegric_fit::landmarks {

using Eigen::Vector3d;

Eigen::Isometry3d body_frame(const body_model::RegisteredBody& body) {
  // Hips and feet say which way she faces: shoulders turn with the arms.
  Vector3d across = body.joint("upperleg01.L") - body.joint("upperleg01.R");
  const std::vector<char> there = body_model::parts_there(body);
  if (there[body.model->part_named("foot_L")] && there[body.model->part_named("foot_R")])
    across += body.joint("foot.L") - body.joint("foot.R");
  const Vector3d up = body.vertical, left = (across - up.dot(across) * up).normalized();
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear().row(0) = left.cross(up);
  frame.linear().row(1) = left;
  frame.linear().row(2) = up;
  Vector3d origin = 0.5 * (body.joint("foot.L") + body.joint("foot.R"));
  origin += (body.ground - up.dot(origin)) * up;
  frame.translation() = -(frame.linear() * origin);
  return frame;
}

}  // namespace tensegric_fit::landmarks
