/// Distortion of the deformed skin (P1 Fig. 8; DESIGN §5).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::tffd {

/// At each control vertex: area of the triangles around it, after / before. 1 where nothing changed.
std::vector<double> control_distortion(const geometry::ControlMesh& control, const std::vector<Eigen::Vector3d>& outer);

/// The same at each body vertex, carried from the control mesh; exactly 1 where the body was not touched.
std::vector<double> body_distortion(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                                    const std::vector<double>& at_control_vertices);

}  // namespace tensegric_fit::tffd
