/// The truth of a body that is the body model's posed skin.
#pragma once

#include "body_model/posed_model.hpp"
#include "virtual_body/skin.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::virtual_body {

/// Fills body.truth, doubts and waist_method, in the body's frame. `skin`: the model with these parameters,
/// subdivided: its first vertices are the model's own. \throw Refusal bad_option: an armpit or a fold under a
/// breast is missing
void measure_model_body(const body_model::Model& model, const body_model::Parameters& parameters,
                        const Skin& skin, VirtualBody& body);

}  // namespace tensegric_fit::virtual_body
