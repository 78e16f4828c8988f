#include "tensegric/shape_check.hpp"

namespace tensegric_fit::tensegric {

TriangleChange triangle_change(const Model& model, const Positions& x) {
  TriangleChange change;
  const auto& outer = model.control.outer;
  for (const Eigen::Vector3i& t : model.control.triangles) {
    const Eigen::Vector3d before = geometry::area_vector(outer[t[0]], outer[t[1]], outer[t[2]]);
    const Eigen::Vector3d after = geometry::area_vector(x[t[0]], x[t[1]], x[t[2]]);
    if (after.norm() < 0.5 * before.norm()) ++change.below_half;
    if (before.dot(after) < 0) ++change.turned_over;
  }
  return change;
}

std::string shape_note(const Model& model, const Positions& x) {
  const TriangleChange change = triangle_change(model, x);
  std::string note;
  if (change.below_half > 0)
    note = std::to_string(change.below_half) + " control triangles are compressed below half their area.";
  if (change.turned_over > 0)
    note +=
        (note.empty() ? "" : " ") + std::to_string(change.turned_over) + " control triangles turned over.";
  return note;
}

}  // namespace tensegric_fit::tensegric
