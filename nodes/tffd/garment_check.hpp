/// Everything that there is to warn of when a garment is worn (README.md).
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "tffd/skin_check.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::tffd {

/// check_skin, check_crossings, then under_constricted. `scanned`: the skin's places in the scan's posture,
/// where the lines' courses at rest and the warnings' places before are; `skin.rest` may be posed. \throw
/// Refusal as both
std::vector<geometry::FitWarning> check_garment(const std::vector<Eigen::Vector3d>& scanned,
                                                const WornSkin& skin, const std::vector<WornLine>& lines,
                                                const HoldOptions& options);

}  // namespace tensegric_fit::tffd
