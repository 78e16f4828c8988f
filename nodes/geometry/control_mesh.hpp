/// The control mesh: the tensegric model is built on it, and it drives t-FFD (P1 §3.3, Fig. 4).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// A constraining line (P1 §3.5): the outer nodes that it runs over, in order.
struct ControlLine {
  std::string name;
  std::vector<int> nodes;
};

/// A part of the control mesh whose volume is conserved separately (P2 §2.3).
struct ControlRegion {
  std::string name;
  std::vector<int> triangles;
};

/// Outer nodes lie on the skin, inner node i lies below outer node i (P2 §2.1, "the supposed thickness of a
/// soft tissue"). All per-node arrays have one entry per outer node. Metres, the scan's frame; triangles
/// counter-clockwise from outside.
struct ControlMesh {
  std::vector<Eigen::Vector3d> outer;
  std::vector<Eigen::Vector3d> inner;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<char> outer_fixed;
  std::vector<char> inner_fixed;
  std::vector<std::string> names;  ///< empty where a node has no name
  std::vector<ControlRegion> regions;
  std::vector<ControlLine> lines;

  /// Index of the outer node of that name, or -1.
  int node(const std::string& name) const;
};

/// \throw Refusal bad_mesh: array sizes that do not match, indices out of range, no region, a non-manifold
/// edge; non_finite
void check_control_mesh(const ControlMesh& control);

/// Several control meshes of one body as one: the pieces stay unconnected, nodes are numbered consecutively.
/// \throw Refusal bad_template: two of them have a node, a region or a line of the same name
ControlMesh joined(const std::vector<ControlMesh>& parts);

/// The region's own triangles.
std::vector<Eigen::Vector3i> region_triangles(const ControlMesh& control, const ControlRegion& region);

/// The fixed apex of the region's tetrahedra: the centre of gravity of its outer nodes at rest (P1 §3.4).
Eigen::Vector3d region_apex(const ControlMesh& control, const ControlRegion& region);

/// Nodes along the shortest path over the mesh's edges that visits `stops` in order; ties go to the lower
/// index. `line`: its name, for the refusal. \throw Refusal unknown_line: two stops are in parts of the mesh
/// that are not connected.
std::vector<int> route_over_edges(const ControlMesh& control, const std::vector<int>& stops,
                                  const std::string& line);

}  // namespace tensegric_fit::geometry
