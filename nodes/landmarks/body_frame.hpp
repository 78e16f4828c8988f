/// The body's own frame.
#pragma once

#include "body_model/registered_body.hpp"

namespace tensegric_fit::landmarks {

/// Takes the scan's frame to the body's (REP 103): x forward, y to her left, z up, on the ground between the
/// feet.
Eigen::Isometry3d body_frame(const body_model::RegisteredBody& body);

}  // namespace tensegric_fit::landmarks
