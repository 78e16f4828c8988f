/// Skin that no sensor saw, as the registered body model has it.
#pragma once

#include "body_model/registered_body.hpp"
#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

/// Points with outward normals, some millimetres apart, on the model's skin where no point of `seen` that
/// faces the same way is near though some are around: armpits, folds, crotch, crown, soles. Not on hands,
/// which are never as the model has them, nor where two parts of the model run into each other. All in one
/// frame, metres. \pre seen is not empty
geometry::PointCloud unseen_skin(const body_model::RegisteredBody& body, const geometry::PointCloud& seen);

}  // namespace tensegric_fit::reconstruction
