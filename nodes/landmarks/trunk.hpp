/// The trunk without its arms.
#pragma once

#include "landmarks/armpit.hpp"

namespace tensegric_fit::landmarks {

/// Where an arm leaves the trunk.
struct Axilla {
  bool found = false;
  bool filled = false;   ///< the scan did not see it: skin that touches, or a gap that was filled
  bool raised = false;   ///< the arm stands out from the trunk by some 55 degrees or more
  double abduction = 0;  ///< radians from straight down to the upper arm
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

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
  /// The axilla on the roof under a filling.
  void under_filling(const ArmpitRoof& roof, Side side, Axilla& axilla) const;

  const BodyShape& body_;
  Axilla axillae_[2];
};

}  // namespace tensegric_fit::landmarks
