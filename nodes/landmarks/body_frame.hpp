/// Up, front and left of a body, found from its shape alone.
#pragma once

#include <string>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::landmarks {

/// `body_from_scan`: x forward, y left, z up, origin on the floor between the feet. Confidence of the front,
/// 0 to 1.
struct BodyFrame {
  Eigen::Isometry3d body_from_scan;
  double confidence;
  std::string reason;
};

/// \throw Refusal not_a_body, wrong_unit, missing_part:legs
BodyFrame find_body_frame(const geometry::TriangleMesh& body);

}  // namespace tensegric_fit::landmarks
