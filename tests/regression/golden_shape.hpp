/// A recorded shape, kept small: some thousand points of the skin, to a tenth of a millimetre.
#pragma once

#include <string>

#include "case.hpp"
#include "metrics.hpp"
#include "recording.hpp"

namespace tensegric_fit::regression {

/// Whether a case expects anything of it (metrics shape/...).
bool wants_shape(const Case& asked);

/// How far the recorded points of a case are from the skin now, metres: shape/p95, shape/most. The skin is
/// that of the last garment worn, or the body's. Nothing where nothing was recorded or came out. \throw
/// Refusal bad_case: its file is broken
Metrics shape_metrics(const Case& asked, const Recording& recording);

/// Records the skin of now: cases/shapes/NAME.txt, x y z in tenths of a millimetre a line. False where it was
/// recorded like that before.
bool write_shape(const Case& asked, const Recording& recording);

}  // namespace tensegric_fit::regression
