/// Where a garment line runs: its nodes, and its way on the body (README.md, Lines and bands).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "tensegric/garment.hpp"

namespace tensegric_fit::tensegric {

/// Where a line is to be laid on the body: along its points, or over the skin near the nodes of its route.
struct Course {
  std::vector<Eigen::Vector3d> points;  ///< scan frame, m
  std::array<bool, 2> held;             ///< does bone hold its ends
  /// Of a cup, else empty: from the last point to each node of the row on which its fibres end.
  std::vector<std::vector<Eigen::Vector3d>> fan{};
};

/// \throw Refusal as nodes_of
Course course_of(const geometry::ControlMesh& control, const GarmentLine& line);

/// Outer nodes that a line runs over, in order; a cup's down to the middle of its row. \throw Refusal
/// unknown_line: a name that the control mesh does not have; bad_garment: fewer than two nodes, a line
/// "..._L" whose sided nodes are all "..._R", a cup "..._L" with any node "..._R", or the other way round; a
/// cup that spreads over the other side than it comes from, or whose row runs over the node where it begins
std::vector<int> nodes_of(const geometry::ControlMesh& control, const GarmentLine& line);

}  // namespace tensegric_fit::tensegric
