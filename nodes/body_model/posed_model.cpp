#include "body_model/posed_model.hpp"

#include <cmath>

namespace tensegric_fit::body_model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Matrix3d rotation_of(const Vector3d& v) {
  const double angle = v.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, v / angle).toRotationMatrix() : Matrix3d::Identity();
}

/// exp(v + dv) = exp(J dv) exp(v): the left Jacobian of SO(3) (Barfoot 2017, State Estimation for
/// Robotics, 7.77).
Matrix3d left_jacobian(const Vector3d& v) {
  const double angle = v.norm();
  const Matrix3d k = cross(v);
  if (angle < 1e-6) return Matrix3d::Identity() + 0.5 * k;  // the next term is below 1e-12
  const double square = angle * angle;
  return Matrix3d::Identity() + (1 - std::cos(angle)) / square * k +
         (angle - std::sin(angle)) / (square * angle) * k * k;
}

}  // namespace

Parameters::Parameters(const Model& model)
    : turns(model.groups.size(), Vector3d::Zero()), shape(Eigen::VectorXd::Zero(model.components())) {}

Parameters Parameters::plus(const Eigen::VectorXd& step) const {
  Parameters next = *this;
  next.rotation = rotation_of(step.head<3>()) * rotation;
  next.position += step.segment<3>(3);
  next.log_scale += step[kScale];
  for (std::size_t g = 0; g < turns.size(); ++g)
    next.turns[g] += step.segment<3>(kTurns + 3 * static_cast<int>(g));
  next.shape += step.tail(shape.size());
  return next;
}

PosedModel::PosedModel(const Model& model, const Parameters& parameters)
    : model_(model),
      parameters_(parameters),
      bones_(model.bones.size()),
      turns_of_(model.bones.size()),
      shift_by_shape_(model.bones.size()) {
  const double scale = std::exp(parameters.log_scale);
  struct Own {
    int group;
    double share;
  };
  std::vector<std::vector<Own>> own(bones_.size());
  for (std::size_t g = 0; g < model.groups.size(); ++g)
    for (const auto& [bone, share] : model.groups[g].bones) own[bone].push_back({static_cast<int>(g), share});

  bones_[0] = Eigen::Translation3d(parameters.position) * (scale * parameters.rotation) *
              Eigen::Translation3d(-inner_at_rest(0));
  shift_by_shape_[0] = -bones_[0].linear() * model.inner_basis.leftCols<3>().transpose();
  for (std::size_t b = 1; b < bones_.size(); ++b) {
    const int parent = model.bones[b].parent;
    const Eigen::Affine3d& above = bones_[parent];
    const Vector3d rest = inner_at_rest(static_cast<int>(b)), here = above * rest;
    turns_of_[b] = turns_of_[parent];
    // Of several groups that turn a bone the last one listed turns it first.
    Matrix3d turned = above.linear();
    for (const Own& o : own[b]) {
      const Vector3d v = o.share * parameters.turns[o.group];
      turns_of_[b].push_back({o.group, turned / scale * left_jacobian(v) * o.share, here});
      turned = turned * rotation_of(v);
    }
    bones_[b].linear() = turned;
    bones_[b].translation() = here - turned * rest;
    shift_by_shape_[b] = shift_by_shape_[parent] +
                         (above.linear() - turned) *
                             model.inner_basis.middleCols(3 * static_cast<Eigen::Index>(b), 3).transpose();
  }
}

Vector3d PosedModel::inner_at_rest(int index) const {
  return model_.inner_mean[index] +
         model_.inner_basis.middleCols<3>(3 * index).transpose() * parameters_.shape;
}

Vector3d PosedModel::rest_vertex(int v) const {
  const Eigen::Vector3f offset =
      model_.basis.middleCols<3>(3 * v).transpose() * parameters_.shape.cast<float>();
  return model_.mean[v] + offset.cast<double>();
}

Vector3d PosedModel::vertex(int v) const {
  const Vector3d rest = rest_vertex(v);
  Vector3d sum = Vector3d::Zero();
  for (int j = 0; j < Model::kWeights; ++j)
    if (model_.weights[v][j] > 0) sum += model_.weights[v][j] * (bones_[model_.carriers[v][j]] * rest);
  return sum;
}

std::vector<Vector3d> PosedModel::vertices() const {
  const Eigen::VectorXf shape = parameters_.shape.cast<float>();
  const Eigen::VectorXf offset = model_.basis.transpose() * shape;
  std::vector<Vector3d> result(model_.mean.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    const Vector3d rest = model_.mean[v] + offset.segment<3>(3 * static_cast<Eigen::Index>(v)).cast<double>();
    Vector3d sum = Vector3d::Zero();
    for (int j = 0; j < Model::kWeights; ++j)
      if (model_.weights[v][j] > 0) sum += model_.weights[v][j] * (bones_[model_.carriers[v][j]] * rest);
    result[v] = sum;
  }
  return result;
}

Matrix3d PosedModel::blend(int v) const {
  Matrix3d sum = Matrix3d::Zero();
  for (int j = 0; j < Model::kWeights; ++j)
    sum += model_.weights[v][j] * bones_[model_.carriers[v][j]].linear();
  return sum;
}

Vector3d PosedModel::joint(int bone) const {
  return bones_[bone] * inner_at_rest(bone);
}

Vector3d PosedModel::bone_point(int index) const {
  return bones_[model_.bone_points[index].bone] *
         inner_at_rest(static_cast<int>(model_.bones.size()) + index);
}

void PosedModel::derivative(int v, Eigen::Ref<Eigen::Matrix3Xd> into) const {
  const Vector3d rest = rest_vertex(v);
  into.setZero();
  Matrix3d blend = Matrix3d::Zero();
  Vector3d here = Vector3d::Zero();
  auto by_shape = into.rightCols(into.cols() - parameters_.shape_at());
  for (int j = 0; j < Model::kWeights; ++j) {
    const double w = model_.weights[v][j];
    if (w <= 0) continue;
    const int b = model_.carriers[v][j];
    const Vector3d carried = bones_[b] * rest;
    here += w * carried;
    blend += w * bones_[b].linear();
    by_shape += w * shift_by_shape_[b].leftCols(by_shape.cols());
    for (const Turn& turn : turns_of_[b])
      into.middleCols<3>(Parameters::kTurns + 3 * turn.group) -= w * cross(carried - turn.joint) * turn.axes;
  }
  by_shape += blend * model_.basis.middleCols<3>(3 * v).topRows(by_shape.cols()).transpose().cast<double>();
  into.leftCols<3>() = -cross(here - parameters_.position);
  into.middleCols<3>(3).setIdentity();
  into.col(Parameters::kScale) = here - parameters_.position;
}

}  // namespace tensegric_fit::body_model
