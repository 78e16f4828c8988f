/// What is drawn of the registered body model that a message holds.
#pragma once

#include <tensegric_fit/BodyModel.h>

#include "inspect/model_skin.hpp"

namespace tensegric_fit::node {

/// Needs no model file. \throw Refusal bad_model, non_finite, as check_model_skin
inspect::ModelSkin skin_in(const BodyModel& message);

}  // namespace tensegric_fit::node
