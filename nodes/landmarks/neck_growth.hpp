/// Where a neck's girth has grown out of its thinnest loop as much as at the base of other necks.
#pragma once

#include "landmarks/neck_plane.hpp"

namespace tensegric_fit::landmarks {

/// Metres by which `base`, a plane of the neck's base found from the skin under the chin, is to be moved
/// along its normal when the growth of the girth has its say too: a little on a slim neck, most of the way on
/// one whose girth grows fast. Zero where no level within 20 mm has that girth. \param thinnest girth of the
/// neck's thinnest loop, metres
double offset_by_growth(const NeckPlanes& planes, const NeckPlane& base, double thinnest, double stature);

}  // namespace tensegric_fit::landmarks
