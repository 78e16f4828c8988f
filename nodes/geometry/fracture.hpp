/// Skin that a scan shows twice.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/body_measures.hpp"

namespace tensegric_fit::geometry {

/// A body part that was scanned in two places, because the person moved between the exposures of two sensor
/// columns: two layers of points that face the same way. Measures taken there are off by up to `offset`.
struct Fracture {
  Eigen::Vector3d centre;  ///< scan frame, metres
  double radius;           ///< m, of the ball around `centre` that contains the skin seen twice
  double area;             ///< m^2 of skin
  double offset;           ///< m, largest distance between the two layers along their normal
};

/// Lowers the confidence of landmarks in a fracture, of girths whose tape runs through one and of heights
/// that are read from either, widens their intervals by its offset, and adds the reason. Not of the stature:
/// fractures are looked for below the head.
void doubt_fractured(const std::vector<Fracture>& fractures, BodyMeasures& measures);

}  // namespace tensegric_fit::geometry
