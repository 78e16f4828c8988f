/// The trunk without its arms.
#pragma once

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// Where an arm leaves the trunk.
struct Axilla {
  bool found = false;
  bool filled =
      false;  ///< arm and trunk are joined below it too: skin that touches, or a gap that was filled
  bool raised = false;   ///< the arm stands out from the trunk by some 55 degrees or more
  double abduction = 0;  ///< radians from straight down to the upper arm
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Root root;      ///< of an arm that hangs
  Bridge bridge;  ///< over a filled armpit, 0.003 statures above `point`
};

/// Where the axilla of a filled armpit lies on a body that stoops by so many radians; one that was seen is
/// where it is.
Eigen::Vector3d axilla_with_stoop(const Axilla& axilla, double stoop, double stature);

class Trunk {
 public:
  explicit Trunk(const BodyShape& body);

  /// The trunk's own loop at a height, arms cut off where they are fused with it; empty where there is no
  /// trunk.
  std::vector<Outline> outline_at(double height) const;

  /// That loop and what else belongs to the trunk: breasts that hang free at this height.
  std::vector<Outline> outlines_with_breasts_at(double height) const;

  const Axilla& axilla(Side side) const { return axillae_[side]; }

  /// Height at which the chest ends: mean of the axillae found, or a share of stature where there are no
  /// arms.
  double axilla_height() const;

 private:
  Axilla find_axilla(Side side) const;
  /// Where arm and trunk would part without the skin that fills the armpit.
  void look_under_filling(Axilla& axilla) const;

  const BodyShape& body_;
  Axilla axillae_[2];
};

}  // namespace tensegric_fit::landmarks
