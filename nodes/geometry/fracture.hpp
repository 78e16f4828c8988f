/// Skin that a scan shows twice.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/body_measures.hpp"

namespace tensegric_fit::geometry {

/// A body part that was scanned in two places, because the person moved between one column's turn and
/// another's: two sheets of points that face the same way. What is measured there is off by up to `offset`.
struct Fracture {
  Eigen::Vector3d centre;  ///< scan frame, metres
  double radius;           ///< m, of the ball around `centre` that holds what was seen twice
  double area;             ///< m^2 of skin
  double offset;           ///< m between the two sheets, along their normal, where they are farthest apart
};

/// Lowers the confidence of the landmarks, and of the girths whose tape runs, where the scan shows skin
/// twice, and says why.
void doubt_fractured(const std::vector<Fracture>& fractures, BodyMeasures& measures);

}  // namespace tensegric_fit::geometry
