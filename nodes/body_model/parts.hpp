/// Which part of the body a vertex of a mesh belongs to.
#pragma once

#include <vector>

#include "body_model/registered_body.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {

/// A vertex whose part nobody knows: the model's skin is far away.
inline constexpr unsigned char kUnknownPart = 255;

/// One per vertex of the mesh, in the model's frame: the vertex of the model's skin that is nearest and faces
/// the same way, lost_skin left out.
std::vector<int> nearest_skin(const geometry::TriangleMesh& mesh, const RegisteredBody& body);

/// One per vertex of the mesh, in the model's frame: index into the model's parts, of the nearest skin that
/// faces the same way, or kUnknownPart where that is farther than Matching::kUnmatched.
std::vector<unsigned char> parts_of(const geometry::TriangleMesh& mesh, const RegisteredBody& body);

}  // namespace tensegric_fit::body_model
