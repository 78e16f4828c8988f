/// Landmarks of the parametric body from its function, not from its mesh.
#pragma once

#include <vector>

#include "geometry/body_measures.hpp"
#include "virtual_body/body_shape.hpp"

namespace tensegric_fit::virtual_body {

/// Body frame, all on the skin, confidence 1: the usual names and fold_lowest_L/R. Definitions:
/// bust point: tip of the nipple; underbust: most concave point of the sagittal profile under the bust point;
/// fold_lowest: lowest such point from there to 55 mm towards the middle; shoulder: over the outer end of the
/// collarbone; axilla: where trunk and arm part; crotch: perineum, on the level bridge between the legs;
/// buttock: rearmost point of either half. \throw Refusal bad_option: a breast so large that it has no fold
/// under its bust point
std::vector<geometry::Landmark> find_body_landmarks(const BodyShape& shape);

}  // namespace tensegric_fit::virtual_body
