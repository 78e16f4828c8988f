/// What the definitions of the measures leave open on a virtual body. A figure is vague where another reader
/// of the same definition could be off by more than ISO 20685 allows; hidden where no sensor can see the
/// place. Each of these adds to body.doubts, in the body's frame, what concerns it; the truth's landmarks,
/// heights and girths are there.
#pragma once

#include "virtual_body/sagittal.hpp"
#include "virtual_body/skin.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::virtual_body {

/// Underbust: a fold without a crease, two folds, or one so narrow that no sensor sees its bottom.
void doubt_folds(const Skin& skin, VirtualBody& body);

/// Crotch: a midline level from front to back; thighs that hide it.
void doubt_crotch(const Skin& skin, VirtualBody& body);

/// Shoulder point under flesh or of a raised arm, and the axilla, which nothing holds from front to back.
/// `upper_arm`: from the shoulder joint downwards.
void doubt_shoulder(const Skin& skin, const Ray& upper_arm, Side side, VirtualBody& body);

}  // namespace tensegric_fit::virtual_body
