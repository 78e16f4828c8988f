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
///   thickness: 0.01                             # metres; default: half the mean edge
struct ShapeFixing {
  std::vector<int> nodes;
  std::vector<std::array<Eigen::Vector3d, 2>> boxes;  ///< lowest and highest corner
  double thickness = 0;                               ///< 0: half the mean edge
};

/// \throw Refusal bad_template naming file and key
ShapeFixing load_shape_fixing(const std::string& path);

/// One region "shape" over the whole mesh; inner nodes lie below along the normal.
/// \throw Refusal bad_mesh; bad_template: a fixed node that the mesh does not have
geometry::ControlMesh control_from_shape(const geometry::TriangleMesh& mesh, const ShapeFixing& fixing);

}  // namespace tensegric_fit::control_mesh
