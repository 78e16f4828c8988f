/// Parts of the body at each vertex of a mesh, from the registered body model.
#pragma once

#include "body_model/registered_body.hpp"
#include "landmarks/surface.hpp"

namespace tensegric_fit::landmarks {

/// The mesh in the body's frame, labelled by the nearest skin of the model that faces the same way. `filled`
/// as for find_landmarks.
Surface labelled(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                 const body_model::RegisteredBody& body, const Eigen::Isometry3d& body_from_scan);

/// The model's skin, or what pose and shape alone make of it (RegisteredBody::posed), in the body's frame.
Surface skin_of(const body_model::RegisteredBody& body, const std::vector<Eigen::Vector3d>& skin,
                const Eigen::Isometry3d& body_from_scan);

}  // namespace tensegric_fit::landmarks
