/// The body's own frame, and its surfaces in it.
#pragma once

#include "body_model/registered_body.hpp"
#include "landmarks/surface.hpp"

namespace tensegric_fit::landmarks {

/// Takes the scan's frame to the body's (REP 103): x forward, y to her left, z up, on the ground between the
/// feet.
Eigen::Isometry3d body_frame(const body_model::RegisteredBody& body);

/// The mesh in the body's frame, labelled by the nearest skin of the model that faces the same way. `filled`
/// as for find_landmarks.
Surface labelled(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                 const body_model::RegisteredBody& body, const Eigen::Isometry3d& body_from_scan);

/// The model's skin, or what pose and shape alone make of it (RegisteredBody::posed), in the body's frame.
Surface skin_of(const body_model::RegisteredBody& body, const std::vector<Eigen::Vector3d>& skin,
                const Eigen::Isometry3d& body_from_scan);

}  // namespace tensegric_fit::landmarks
