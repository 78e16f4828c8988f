/// Everything that there is to warn of when a garment is worn (README.md).
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "tffd/skin_check.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::tffd {

/// A body's skin as it was scanned. Only borrowed.
struct ScannedSkin {
  const std::vector<Eigen::Vector3d>& vertices;  ///< in the scan's posture
  std::vector<char> filled = {};  ///< empty, or one flag per vertex: 1 where the scan saw nothing
};

/// check_skin, check_crossings, under_constricted, skin_over_lines, then not_scanned. Where `scanned` is the
/// lines' courses at rest and the warnings' places before are; `skin.rest` may be posed. \throw Refusal as
/// these
std::vector<geometry::FitWarning> check_garment(const ScannedSkin& scanned, const WornSkin& skin,
                                                const std::vector<WornLine>& lines,
                                                const HoldOptions& options);

}  // namespace tensegric_fit::tffd
