/// The model in a pose: where its skin is, and how that depends on each parameter.
#pragma once

#include <Eigen/Geometry>

#include "body_model/model.hpp"

namespace tensegric_fit::body_model {

inline constexpr double kDegree = M_PI / 180;

/// What makes a person of the model, in the frame of a scan.
struct Parameters {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< model axes -> scan axes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< of the pelvis joint, m
  double log_scale = 0;                                    ///< of her stature over the model's
  std::vector<Eigen::Vector3d> turns;                      ///< rotation vector of each pose group, rad
  Eigen::VectorXd shape;                                   ///< coefficients, in standard deviations

  Parameters() = default;
  /// Those of the mean woman at rest.
  explicit Parameters(const Model& model);

  /// Their number, and where the turns and the shape begin: rotation (3), position (3), log_scale, turns,
  /// shape.
  int count() const { return kTurns + 3 * static_cast<int>(turns.size()) + static_cast<int>(shape.size()); }
  static constexpr int kScale = 6, kTurns = 7;
  int shape_at() const { return kTurns + 3 * static_cast<int>(turns.size()); }

  /// Moved by a step of count() numbers; that of the rotation turns about the scan's axes.
  Parameters plus(const Eigen::VectorXd& step) const;
};

class PosedModel {
 public:
  /// Both must outlive it.
  PosedModel(const Model& model, const Parameters& parameters);

  /// A vertex of the skin, m, scan frame.
  Eigen::Vector3d vertex(int v) const;
  /// All of them.
  std::vector<Eigen::Vector3d> vertices() const;
  /// A vertex at rest, m.
  Eigen::Vector3d rest_vertex(int v) const;
  /// What turns and stretches the skin round a vertex.
  Eigen::Matrix3d blend(int v) const;
  /// A joint (0 to bones - 1), m, scan frame.
  Eigen::Vector3d joint(int bone) const;
  /// A bone point, m, scan frame.
  Eigen::Vector3d bone_point(int index) const;
  /// Rest -> scan frame, of one bone (with the scale).
  const Eigen::Affine3d& bone(int bone) const { return bones_[bone]; }

  /// d vertex / d parameters, the first of them: 3 x at least Parameters::shape_at(), at most count().
  void derivative(int v, Eigen::Ref<Eigen::Matrix3Xd> into) const;

 private:
  Eigen::Vector3d inner_at_rest(int index) const;

  const Model& model_;
  const Parameters& parameters_;
  std::vector<Eigen::Affine3d> bones_;
  /// For each bone: pose groups that turn it or a bone above it, each with the axis matrix and the joint.
  struct Turn {
    int group;
    Eigen::Matrix3d axes;  ///< group's rotation vector step -> rotation step about the scan's axes
    Eigen::Vector3d joint;
  };
  std::vector<std::vector<Turn>> turns_of_;
  std::vector<Eigen::Matrix3Xd> shift_by_shape_;  ///< d bone's translation / d shape
};

}  // namespace tensegric_fit::body_model
