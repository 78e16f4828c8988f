/// Girths and heights after the skin has moved.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/posture.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// A body's skin before and after. Holds references only; `after` has one position per vertex of `before`.
/// Metres, scan frame.
struct MovedSkin {
  const TriangleMesh& before;
  const std::vector<Eigen::Vector3d>& after;
};

/// `after` of a body that the bones carry, taken back to the scan's posture: what a garment alone does to it.
/// \pre one position per vertex of `before`
std::vector<Eigen::Vector3d> in_scan_posture(const TriangleMesh& before,
                                             const std::vector<Eigen::Vector3d>& after,
                                             const BoneFrames& bones);

/// The points displaced as the places of the skin nearest to them are. As a CarriedPoints that is used once.
std::vector<Eigen::Vector3d> carried(const std::vector<Eigen::Vector3d>& points, const MovedSkin& skin);

/// The same of all landmarks, in their order.
std::vector<Eigen::Vector3d> landmarks_after(const BodyMeasures& measures, const MovedSkin& skin);

/// A girth's tape after the skin has moved: in the plane of `loop`, the tape before, round the skin that was
/// inside it. Skin outside the tape before (arms, the other thigh, breasts overhanging their fold) counts
/// only where it has come from another level. Empty where the plane cuts no such skin.
std::vector<Eigen::Vector3d> tape_after(const MovedSkin& skin, const std::vector<Eigen::Vector3d>& loop);

/// A height or a girth before and after, metres; `after` is empty where it is unknown.
struct ChangedMeasure {
  Measure before;
  std::optional<double> after;
  /// m, for where both values stand beside it: their difference, each rounded to the millimetre. \pre after
  double change() const;
};

/// Each girth in the plane in which it was measured; `after` is empty for girths without a recorded tape.
std::vector<ChangedMeasure> girths_after(const BodyMeasures& measures, const MovedSkin& skin);

/// Distance of the bust points, `before` named bust_points; nothing where one was not found.
std::optional<ChangedMeasure> bust_points_apart(const BodyMeasures& measures, const MovedSkin& skin);

/// Each height by the displacement of the landmarks that define it, underbust by the lower fold's; stature by
/// the highest vertex.
std::vector<ChangedMeasure> heights_after(const BodyMeasures& measures, const MovedSkin& skin);

}  // namespace tensegric_fit::geometry
