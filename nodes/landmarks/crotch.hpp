/// Where the legs join, though thighs touch or skin that no sensor saw fills the gap between them.
#pragma once

#include "landmarks/body_levels.hpp"
#include "landmarks/junction.hpp"

namespace tensegric_fit::landmarks {

/// Height of the perineum, and the bridge between the legs 5 mm above the place where they join.
Junction find_crotch_junction(const SlicedMesh& sliced, const BodyLevels& levels);

}  // namespace tensegric_fit::landmarks
