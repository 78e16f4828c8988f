/// Arms and hands that are fused with the trunk in a section.
#pragma once

#include "landmarks/outline.hpp"

namespace tensegric_fit::landmarks {

/// Cuts off a lobe on each side that hangs on the trunk by a neck much narrower than its own girth: an arm
/// where the armpit is filled, a hand that touches the thigh. What has no such lobe comes back as it is. \pre
/// y is the lateral direction
Outline without_arms(const Outline& trunk, double stature);

}  // namespace tensegric_fit::landmarks
