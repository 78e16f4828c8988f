#include "tensegric/shape_check.hpp"

#include <algorithm>

namespace tensegric_fit::tensegric {

namespace {

constexpr double kFacing = -0.5;  // cosine of the normals of two triangles that came to face each other

// Triangles at an edge that was folded over, of a shape that may bend as far round as it likes: it turns as a
// whole, so that its triangles' normals say nothing one by one.
int folded_over(const Model& model, const Positions& x) {
  const auto& outer = model.control.outer;
  const auto& triangles = model.control.triangles;
  const auto facing = [&triangles](const Positions& at, const geometry::Edge& e) {
    const auto normal = [&](int t) {
      return geometry::area_vector(at[triangles[t][0]], at[triangles[t][1]], at[triangles[t][2]])
          .normalized();
    };
    return normal(e.left).dot(normal(e.right));
  };
  std::vector<char> folded(triangles.size(), 0);
  for (const geometry::Edge& e : geometry::edges_of({outer, triangles}))
    if (e.right >= 0 && facing(outer, e) > 0 && facing(x, e) < kFacing) folded[e.left] = folded[e.right] = 1;
  return static_cast<int>(std::count(folded.begin(), folded.end(), 1));
}

}  // namespace

TriangleChange triangle_change(const Model& model, const Positions& x) {
  TriangleChange change;
  const auto& outer = model.control.outer;
  for (const Eigen::Vector3i& t : model.control.triangles) {
    const Eigen::Vector3d before = geometry::area_vector(outer[t[0]], outer[t[1]], outer[t[2]]);
    const Eigen::Vector3d after = geometry::area_vector(x[t[0]], x[t[1]], x[t[2]]);
    if (after.norm() < 0.5 * before.norm()) ++change.below_half;
    if (model.options.inner == InnerNodes::bound && before.dot(after) < 0) ++change.turned_over;
  }
  if (model.options.inner == InnerNodes::free) change.turned_over = folded_over(model, x);
  return change;
}

std::string shape_note(const Model& model, const Positions& x) {
  const TriangleChange change = triangle_change(model, x);
  std::string note;
  if (change.turned_over > 0)
    note = "The shape folds over itself and is not to be trusted: loosen the garment. (Details: " +
           std::to_string(change.turned_over) + " patches of the model turned over.)";
  if (change.below_half > 0)
    note += std::string(note.empty() ? "" : " ") +
            "In places skin would be pressed to less than half its area: loosen the line that pulls most, or "
            "take a "
            "softer band. (Details: " +
            std::to_string(change.below_half) + " patches of the model below half.)";
  return note;
}

}  // namespace tensegric_fit::tensegric
