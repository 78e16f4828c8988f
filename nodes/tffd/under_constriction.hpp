/// Lines of a garment that do not hold what they lie on (P1 §1, §5: under-constricted parts; README.md).
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "geometry/range.hpp"
#include "tffd/skin_check.hpp"

namespace tensegric_fit::tffd {

/// m: a line that is higher over the skin than this touches nothing: more than the chords of a control mesh
/// stand off a breast.
inline constexpr double kOffSkin = 5e-3;
/// A line that came off the skin over more than this share of its length lifts off (definition).
inline constexpr double kLiftedShare = 0.25;
/// m: half the width of a band where nothing else is said (30 mm): the skin that is held by a line.
inline constexpr double kHeldSkin = 15e-3;
inline constexpr geometry::Range kLeastPull{0, 1e6};  ///< pseudo force

/// Field defaults are the parameters' defaults.
struct HoldOptions {
  /// Pseudo force; a line that pulls less is `weak`. A tenth of what a light bra weighs (100 g, 1 N), in the
  /// calibrated tissue's force, which is about a newton on a chest.
  double least_pull = 0.1;
};

/// One `under_constricted` a line that is, in the garment's order:
/// `slack`: no tension, or a thousandth and more shorter than its neutral length;
/// `weak`: less tension than `least_pull`;
/// `lifts_off`: over more of its length than at rest, by kLiftedShare, it is higher than kOffSkin over the
///   skin. What it bridges at rest is its course, and no fault.
/// `vertices`: skin within kHeldSkin of the skin below the line; of one that lifts off, below the parts that
/// are off. `rest` of the skin is where the lines' courses at rest are: in the scan's posture.
/// \throw Refusal bad_mesh: not one worn place a vertex
std::vector<geometry::FitWarning> under_constricted(const WornSkin& skin, const std::vector<WornLine>& lines,
                                                    const HoldOptions& options);

/// Vertices of all `under_constricted` among them, ascending, each once.
std::vector<int> under_constricted_skin(const std::vector<geometry::FitWarning>& warnings);

}  // namespace tensegric_fit::tffd
