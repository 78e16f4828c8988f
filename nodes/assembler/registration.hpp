/// Small rigid corrections of a booth's columns, found where they see the same skin.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "geometry/range.hpp"

namespace tensegric_fit::assembler {

inline constexpr geometry::Range kMaxShift{0, 0.05}, kMaxTurn{0, 0.1};

/// Field defaults are the parameters' defaults. Metres, radians.
struct RegistrationOptions {
  double max_shift = 0.010;  ///< columns that seem farther off are left as they are
  double max_turn = 0.010;
};

enum class RegistrationStatus {
  refined,     ///< the corrections bring the columns closer to each other
  no_overlap,  ///< no two columns see enough of the same skin
  not_better,  ///< no corrections that brought the columns closer were found
  too_far,     ///< corrections beyond max_shift or max_turn: the calibration is wrong, not merely worn
};

/// "refined", "no_overlap", "not_better", "too_far".
std::string to_string(RegistrationStatus status);

struct Registration {
  /// One per column, to be applied to its points; all identity unless `refined`. Their mean is no motion:
  /// what all columns have in common cannot be seen.
  std::vector<Eigen::Isometry3d> corrections;
  RegistrationStatus status = RegistrationStatus::no_overlap;
  /// Trimmed mean distance between columns along the normal, before and with the corrections; metres, over
  /// matches that took no part in finding them.
  double residual_before = 0, residual_after = 0;
  /// Where it is `too_far`: the column that seems to stand farthest off, by how many m and rad.
  int farthest = -1;
  double farthest_shift = 0, farthest_turn = 0;
};

/// Symmetric point-to-plane ICP (Rusinkiewicz 2019) over all pairs of columns at once: each step solves one
/// system for the motions of all columns. Redescending weights leave out what moved between two columns.
/// Columns are clouds in one frame, with unit normals; one may be empty. `signless`: columns whose normals
/// may point either way; empty: none. \throw Refusal bad_option naming the option and its range
Registration register_columns(const std::vector<geometry::PointCloud>& columns,
                              const RegistrationOptions& options, const std::vector<bool>& signless = {});

}  // namespace tensegric_fit::assembler
