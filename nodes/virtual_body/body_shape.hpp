/// The parametric body as one implicit function: negative inside, zero on the skin, close to the distance
/// near it.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "virtual_body/breast.hpp"
#include "virtual_body/implicit.hpp"
#include "virtual_body/skin.hpp"
#include "virtual_body/spine.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::virtual_body {

/// Body frame (REP 103), metres, upright; yaw and tilt are not part of the shape.
class BodyShape : public Implicit {
 public:
  /// \pre checked parameters
  explicit BodyShape(const BodyParameters& parameters);

  double value(const Eigen::Vector3d& p) const override;
  Eigen::AlignedBox3d half_box() const override;
  /// Where the ray from a point inside leaves the body, at most `reach` metres away.
  Eigen::Vector3d exit_point(const Eigen::Vector3d& inside, const Eigen::Vector3d& direction,
                             double reach = 0.3) const;

  /// Whether a skin point belongs to an arm rather than to the trunk.
  bool is_arm(const Eigen::Vector3d& p) const;
  /// Whether a point is about as near to a breast as to the trunk without breasts.
  bool is_under_breast(const Eigen::Vector3d& p) const;

  Ray breast_axis(bool left) const;     ///< from the middle of the breast to the nipple
  Ray upper_arm_axis(bool left) const;  ///< from the shoulder joint down the upper arm
  Ray neck_axis() const;  ///< from the middle of the neck's base upwards, normal to the base's plane
  /// The outer edge of the shoulder blade, under the skin: it goes up with a raised arm, but not outwards
  /// with weight.
  Eigen::Vector3d acromion(bool left) const;
  /// Where a point of the reference body is on this one, and the direction `direction` there.
  Eigen::Vector3d posed(const Eigen::Vector3d& reference) const;
  Eigen::Vector3d posed_bone(const Eigen::Vector3d& reference) const;  ///< bones do not thicken
  Eigen::Vector3d posed_direction(const Eigen::Vector3d& reference, const Eigen::Vector3d& direction) const;
  /// The same place on this body without a stoop.
  Eigen::Vector3d upright(const Eigen::Vector3d& p) const;
  /// A length of the reference body (stature 1.70 m) on this one.
  double scaled(double reference) const { return scale_ * reference; }

 private:
  // On the reference body; p and side mirror as one. All but arm() take points of the body without a stoop.
  double thickness(double z) const;  // of the trunk, relative to the reference
  Eigen::Vector3d thickened(const Eigen::Vector3d& p) const;
  double trunk_without_breasts(const Eigen::Vector3d& p) const;
  double trunk(const Eigen::Vector3d& p) const;
  double breasts(const Eigen::Vector3d& p) const;
  double arm(const Eigen::Vector3d& p) const;
  double trunk_and_arm(const Eigen::Vector3d& p) const;  // where they meet without the armpit's folds
  double armpit_folds(const Eigen::Vector3d& p) const;
  double armpit_height() const;
  double arms_set_out() const;  // how far weight sets each shoulder joint outwards, clear of the trunk
  double head(const Eigen::Vector3d& p) const;
  double reference_value(const Eigen::Vector3d& p) const;

  double scale_, build_, waist_, hip_, belly_;
  Eigen::Vector3d navel_;
  double arm_thickness_;
  Spine spine_;
  Loft torso_, leg_, upper_arm_, forearm_;
  std::vector<Breast> breasts_;                                // left, right (mirrored to the left side)
  Eigen::Isometry3d upper_arm_from_body_, forearm_from_body_;  // left side
  double armpit_;                                              // z of its roof
};

}  // namespace tensegric_fit::virtual_body
