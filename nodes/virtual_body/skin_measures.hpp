/// Heights and girths of a virtual body on its own skin, the same for all families, and what their
/// definitions leave open on it. Definitions: README.
#pragma once

#include <array>
#include <string>

#include "virtual_body/sagittal.hpp"
#include "virtual_body/skin.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::virtual_body {

/// What measuring needs besides skin and landmarks; body frame, metres.
struct BodyAxes {
  Ray neck;                       ///< from the middle of its base upwards, normal to the base's plane
  std::array<Ray, 2> upper_arms;  ///< from the shoulder joint down the arm
  std::array<Ray, 2> thighs;      ///< upwards along the middle of the thigh
  double scale;                   ///< of her stature over 1.70 m
};

/// Adds heights, girths, their loops, and doubts to a body whose truth has its landmarks, all in the body's
/// frame; sets the waist's method.
void measure_skin(const Skin& skin, const BodyAxes& axes, VirtualBody& body);

}  // namespace tensegric_fit::virtual_body
