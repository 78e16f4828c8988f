/// Where landmarks are on a surface, near where the body model has them. Each finder is its definition
/// (README) and nothing else: what to make of a place that no sensor saw is decided by whoever calls it.
#pragma once

#include <array>
#include <optional>

#include "landmarks/surface.hpp"

namespace tensegric_fit::landmarks {

using Eigen::Vector3d;

struct Nipple {
  Vector3d place;
  double shift;  ///< m: by which skin as rough as what the fit leaves over moves such a bump
};
/// The nipple: where a bump of its size stands out most clearly from a smooth breast, some deviations (m)
/// round `expected`, seen along `outward` (unit). Nothing where none stands out of the noise. Under clothes
/// a pointed breast is such a bump, less clear, and further from where the nipple is.
std::optional<Nipple> find_nipple(const Surface& surface, const Vector3d& expected, double deviation,
                                  const Vector3d& outward);

/// The inframammary fold from below the bust point 55 mm inwards: most concave places of sagittal profiles
/// 2.5 mm apart.
struct Fold {
  std::vector<Vector3d> places;  ///< the first below the bust point; empty where nothing is concave
  Vector3d lowest = Vector3d::Zero();
};
/// `expected`: places of the fold on another surface of the body, in the same order, or the first alone:
/// looked for within `reach` (m).
Fold find_fold(const Trunk& trunk, const Vector3d& bust_point, Side side,
               const std::vector<Vector3d>& expected, double reach);

/// Where the back of a buttock is rearmost, by a parabola through its profiles near `start_at`; nothing where
/// it has no apex there.
std::optional<Vector3d> find_buttock(const Trunk& trunk, const Vector3d& start_at);

/// Where the skin between a buttock and the back of the thigh `length` metres under it lies deepest under a
/// straight edge laid on both; nothing where that is less than `depth` metres.
std::optional<Vector3d> find_gluteal_fold(const Trunk& trunk, const Vector3d& buttock, double length,
                                          double depth);

/// Where the sagittal profile from `start` has gone down by `down` (m); nothing where it ends before.
std::optional<Vector3d> skin_under(const Trunk& trunk, const Vector3d& start, double down);

/// The trunk's farthest skin to one side at a height, in the middle of what is flat.
std::optional<Vector3d> find_side(const Trunk& trunk, Side side, double height);

/// The tape round what the selected triangles have within `reach` (m) of `origin` in the plane perpendicular
/// to `along` (unit); empty where they have nothing.
std::vector<Vector3d> round_limb(const Surface& surface, const Vector3d& origin, const Vector3d& along,
                                 double reach, const Selected& selected);

/// Least girth between two heights; nothing where the girth has no minimum in between.
std::optional<double> find_waist(const Trunk& trunk, double lowest, double highest);

/// Lowest place of the midline between the legs, near `expected`.
std::optional<Vector3d> find_crotch(const Surface& surface, const Vector3d& expected);

/// Middle of the gap between arm and trunk on the highest level plane that parts them; of an arm held out, of
/// a plane that rises outwards by `rise` rad. `lowest`, `highest`: heights between which it is looked for.
std::optional<Vector3d> find_axilla(const Surface& surface, Side side, double lowest, double highest,
                                    double rise);

/// The highest skin on the vertical through a point under the skin.
std::optional<Vector3d> skin_above(const Surface& surface, const Vector3d& point);

/// Least girth of the neck in planes parallel to the one through `base`, from there to 40 mm along `along`
/// (unit): its tape; empty where no closed loop runs round.
std::vector<Vector3d> find_neck(const Surface& surface, const Vector3d& base, const Vector3d& along);

}  // namespace tensegric_fit::landmarks
