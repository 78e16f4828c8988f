/// What is drawn over a body in lines: control mesh and garment.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {

/// An open polyline in one colour; metres.
struct Stroke {
  std::vector<Eigen::Vector3d> points;
  Colour colour;
};

/// A garment line with the force along it.
struct TenseLine {
  std::vector<int> nodes;  ///< outer nodes of the control mesh that it runs over
  double tension;          ///< pseudo force
  /// Where it runs, for a line that lies on the skin and not over nodes; m, one per point.
  std::vector<Eigen::Vector3d> course_at_rest{}, course{};
};

/// The nodes a little above the skin: chords between them would sink into it.
std::vector<Eigen::Vector3d> lifted(const std::vector<Eigen::Vector3d>& outer,
                                    const std::vector<Eigen::Vector3i>& triangles);

/// One stroke an edge, over the outer nodes at `outer`.
std::vector<Stroke> edge_strokes(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer);

/// One per line, coloured by tension. \throw Refusal bad_mesh: a node that the control mesh does not have
std::vector<Stroke> line_strokes(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer,
                                 const std::vector<TenseLine>& lines);

}  // namespace tensegric_fit::inspect
