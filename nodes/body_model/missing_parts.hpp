/// Which parts of a registered body are there, and which are missing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "body_model/registered_body.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {

/// Of each part, the share of its skin that has samples: what `there` is filled with. What follows takes it
/// from there, or counts anew.
std::vector<double> shares_there(const RegisteredBody& body);

/// Marks skin of the model that the mesh lacks, for example of a limb that came off as a separate piece, as
/// not scanned: raises `support`, recounts `there`. Surface of other limbs does not count. \pre `mesh` was
/// made of the scan, is in the body's frame and has passed check_mesh; each vertex is of a triangle
void mark_skin_without_surface(RegisteredBody& body, const geometry::TriangleMesh& mesh);

/// Head and limbs (upper_arm_L, forearm_L, hand_L, thigh_L, shank_L, foot_L, ..._R) of which the scanned
/// surface has less than 55 %, and the trunk, and `crown`, the top of the head; what hangs on a missing part
/// is named in its reason.
std::vector<geometry::Missing> missing_parts(const RegisteredBody& body);

/// Of each part of the model, whether the scanned surface has 55 % of it or more.
std::vector<char> parts_there(const RegisteredBody& body);

/// Of each vertex of the skin, whether it is of a limb that is not there and lies in or on other skin, which
/// is then not the limb's.
std::vector<char> lost_skin(const RegisteredBody& body);

/// Whether the scan has 55 % or more of her left and of her right one of a part, as "foot".
std::array<bool, 2> sides_there(const RegisteredBody& body, const std::string& part);

/// Neither foot is there: nothing shows where she stands.
bool lacks_feet(const RegisteredBody& body);

}  // namespace tensegric_fit::body_model
