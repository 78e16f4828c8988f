/// What is found on sagittal sections of the true skin: folds under the breasts, the buttocks, the crotch.
/// Body frame, metres. Definitions: README.
#pragma once

#include <optional>
#include <vector>

#include "geometry/side.hpp"
#include "virtual_body/skin.hpp"

namespace tensegric_fit::virtual_body {

using geometry::kLeft;
using geometry::kRight;
using geometry::kSides;
using geometry::kSign;
using geometry::kSuffix;
using geometry::Side;

/// The fold under a breast.
struct Fold {
  Eigen::Vector3d place;   ///< straight below the bust point
  Eigen::Vector3d lowest;  ///< from there to 55 mm towards the middle
  double curvature = 0;    ///< 1/m, at `place`: positive where the skin is hollow
  double width = 0;        ///< m along the profile that is 0.8 times as hollow or more
  bool rival = false;      ///< whether a hollow elsewhere is 0.8 times as deep
  double opening = 0;      ///< rad, between the skin 20 mm up and 20 mm down from `place`
};
/// Nothing where the skin below the bust point is nowhere hollow.
std::optional<Fold> find_fold(const Skin& skin, const Eigen::Vector3d& bust_point, Side side);

/// Where a buttock is rearmost.
struct Buttock {
  Eigen::Vector3d apex;
  double flat = 0;  ///< m of height over which the skin is within 0.3 mm of the rearmost
};
/// Apex of a parabola through the profiles round `rearmost`, a place on the skin near it.
Buttock find_buttock(const Skin& skin, const Eigen::Vector3d& rearmost);

/// The rearmost vertex of one side of the trunk between two heights, 20 mm or more beside `middle` (y);
/// nothing where there is none.
std::optional<Eigen::Vector3d> rearmost_vertex(const Skin& skin, Side side, double middle, double low,
                                               double high);

/// Lowest place of the midline between the legs.
struct Crotch {
  Eigen::Vector3d lowest;
  double flat = 0;  ///< m from front to back over which it is within 2 mm of the lowest
};
/// `perineum`: a place on the skin within 60 mm of it. \throw Refusal bad_mesh: no skin there
Crotch find_crotch(const Skin& skin, const Eigen::Vector3d& perineum);

}  // namespace tensegric_fit::virtual_body
