/// Which body vertices a control mesh carries, and how much of its motion each one takes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/frame.hpp"
#include "tffd/triangle_grid.hpp"

namespace tensegric_fit::tffd {

/// A body vertex that follows the control mesh.
struct Anchor {
  int vertex;
  double share;  ///< 0 < share <= 1: the part of the control mesh's motion that the vertex takes
};

/// Every vertex of the body that is to follow the control mesh, ascending; all others stay where they are.
///
/// The share is 1 over the moving part of the control mesh and goes to 0 over the triangles at its fixed
/// border: with the barycentric coordinates of the closest point, from fixed border nodes (0) to the other
/// nodes (1). So the skin does not tear where the control mesh ends. Past a border that is free to move, the
/// share goes to 0 within the reach of its triangle.
///
/// A control mesh with a border carries only the skin that it lies on: vertices within reach that face as
/// their closest triangle does, and that body edges join to the skin under its nodes without leaving that
/// set; where that skin ends without a border, as between the thighs, the share grows from 0 over
/// three quarters of a triangle's radius. Not so the arm beside the breast or the back behind it. A closed
/// control mesh without fixed nodes carries the whole body.
///
/// `reach` is in multiples of a triangle's radius. \pre the frames are the control mesh's, in order; the grid
/// was made with that reach
/// \throw Refusal bad_mesh: a control mesh with a border, and a body without triangles
std::vector<Anchor> reach_of(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                             const std::vector<Frame>& frames, const TriangleGrid& grid, double reach);

}  // namespace tensegric_fit::tffd
