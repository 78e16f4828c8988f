/// What becomes of measures where the skin moves.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// A body's skin before and after. Only borrowed; `after` has one place per vertex of `before`. Metres, scan
/// frame.
struct MovedSkin {
  const TriangleMesh& before;
  const std::vector<Eigen::Vector3d>& after;
};

/// Where a point on the skin went: along with the nearest vertex.
Eigen::Vector3d carried(const Eigen::Vector3d& point, const MovedSkin& skin);

/// A girth's tape after the skin has moved: in the plane of `loop`, the tape before, round the skin that
/// belonged to it. Skin outside that tape (arms, the other thigh, breasts over their fold) counts only as far
/// as it came from another level. Empty where the plane meets none.
std::vector<Eigen::Vector3d> tape_after(const MovedSkin& skin, const std::vector<Eigen::Vector3d>& loop);

/// A height or a girth before, and what it is after, metres; nothing where that is not known.
struct ChangedMeasure {
  Measure before;
  std::optional<double> after;
  /// m, as somebody finds it who subtracts the two where they are shown to the millimetre. \pre after
  double change() const;
};

/// Each girth at the plane at which it was measured; those whose tape was not drawn have none after.
std::vector<ChangedMeasure> girths_after(const BodyMeasures& measures, const MovedSkin& skin);

/// Each height where the skin of the landmarks that define it went; stature, that of the highest vertex.
std::vector<ChangedMeasure> heights_after(const BodyMeasures& measures, const MovedSkin& skin);

}  // namespace tensegric_fit::geometry
