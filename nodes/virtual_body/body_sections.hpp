/// The reference body's sections (stature 1.70 m), drawn after the proportions of a slim woman.
#pragma once

#include <vector>

#include "virtual_body/implicit.hpp"

namespace tensegric_fit::virtual_body {

/// Body frame, level sections.
std::vector<Section> torso_sections();
std::vector<Section> leg_sections();
/// z up along the bone, x forward, origin at its upper joint.
std::vector<Section> upper_arm_sections();
std::vector<Section> forearm_sections();

}  // namespace tensegric_fit::virtual_body
