/// A control mesh from any triangle mesh, open or closed (P1 §3.2, Fig. 3): no landmarks, no template.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// Which nodes stay where they are, outer and inner alike, and how thick the units are. YAML, all keys
/// optional:
///   nodes: [0, 5]                               # vertices of the control mesh
///   boxes: [{min: [x, y, z], max: [x, y, z]}]   # and all vertices in these boxes, metres
///   thickness: 0.01                             # metres, at most; default: half the mean edge
struct ShapeFixing {
  std::vector<int> nodes;
  std::vector<std::array<Eigen::Vector3d, 2>> boxes;  ///< lowest and highest corner
  double thickness = 0;                               ///< at most; 0: half the mean edge
};

/// \throw Refusal bad_template naming file and key
ShapeFixing load_shape_fixing(const std::string& path);

/// The mesh itself as control mesh. Inner nodes lie below along the normal, less deep where the shape is
/// thin, so that they never come out on its other side. One volume region a piece, "shape", "shape_2" and so
/// on: a piece does not pay for another's volume. \throw Refusal bad_mesh, also for a piece that is inside
/// out and no hollow of another one; bad_template: a fixed node that the mesh does not have, a piece with
/// fewer than three fixed nodes, units that stay folded however thin they are made
geometry::ControlMesh control_from_shape(const geometry::TriangleMesh& mesh, const ShapeFixing& fixing);

/// The same for the shape simplified to `triangles` triangles (P1 Fig. 3 b). \throw Refusal as above;
/// bad_template: nodes that are fixed by number
geometry::ControlMesh simplified_control(const geometry::TriangleMesh& shape, const ShapeFixing& fixing,
                                         int triangles);

}  // namespace tensegric_fit::control_mesh
