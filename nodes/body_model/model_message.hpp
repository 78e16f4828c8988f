/// The registered body model as a message, and back.
#pragma once

#include <tensegric_fit/BodyModel.h>

#include <memory>
#include <vector>

#include "body_model/registered_body.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

/// `mesh_parts`: of the body mesh, as body_model::parts_of. Skin, `off` and `support` are rounded to float32.
BodyModel to_message(const ScanTag& tag, const body_model::RegisteredBody& body,
                     const std::vector<unsigned char>& mesh_parts);

/// `model` is the one that this build has. \throw Refusal other_model: it was registered with another;
/// bad_model: arrays that do not fit the model, or a pose that is not a rotation and a scale; non_finite
body_model::RegisteredBody registered_in(const BodyModel& message,
                                         const std::shared_ptr<const body_model::Model>& model);

/// Parts of the mesh's vertices. \throw Refusal bad_model: not one per vertex, or a part that has no name
void check_mesh_parts(const BodyModel& message, std::size_t vertices);

}  // namespace tensegric_fit::node
