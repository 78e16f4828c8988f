/// A body with what was measured on it, for a check by eye.
#pragma once

#include <opencv2/core.hpp>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::inspect {

/// The whole body with its landmarks and the tapes of its girths, each with its name in a margin: BGR,
/// `height` pixels high. A ring is a landmark close behind other skin; what is farther behind is not drawn.
/// \throw Refusal as draw()
cv::Mat front_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                      int height = 900);
cv::Mat side_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                     int height = 900);

}  // namespace tensegric_fit::inspect
