/// Skin that a scan shows twice.
#pragma once

#include <Eigen/Core>

namespace tensegric_fit::geometry {

/// A body part that was scanned in two places, because the person moved between one column's turn and
/// another's: two sheets of points that face the same way. What is measured there is off by up to `offset`.
struct Fracture {
  Eigen::Vector3d centre;  ///< scan frame, metres
  double radius;           ///< m, of the ball around `centre` that holds what was seen twice
  double area;             ///< m^2 of skin
  double offset;           ///< m between the two sheets, along their normal, where they are farthest apart
};

}  // namespace tensegric_fit::geometry
