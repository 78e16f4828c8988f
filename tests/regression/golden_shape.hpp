/// A recorded shape: area, centre and spread of the skin of each part of the body, which a reviewer can read,
/// and the hash of its bits.
#pragma once

#include <string>

#include "case.hpp"
#include "metrics.hpp"
#include "recording.hpp"

namespace tensegric_fit::regression {

/// Whether a case expects anything of it (metrics shape/...).
bool wants_shape(const Case& asked);

/// How far the skin of now is from the recorded one. It is that of the last garment worn, or the body's.
///   shape/centre, shape/spread   metres; the largest over all parts and axes
///   shape/area                   share; the largest over all parts
///   shape/bits                   same, or other (on a machine that rounds otherwise, too)
/// Nothing where nothing was recorded or came out; infinite where the parts are others, or not finite.
/// \throw Refusal bad_case: its file is broken
Metrics shape_metrics(const Case& asked, const Recording& recording);

/// Whether the skin of now has other bits than the recorded one, or none was recorded.
bool has_moved(const Case& asked, const Recording& recording);

/// Records the skin of now: cases/shapes/NAME.yaml.
void write_shape(const Case& asked, const Recording& recording);

}  // namespace tensegric_fit::regression
