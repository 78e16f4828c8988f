/// Shapes that are no bodies, to show that the tensegric model stands on any of them (P1 §3.2, Fig. 3).
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::virtual_body {

/// A closed shape with the box whose part of it is meant to be held. Metres, x forward, z up, its own mirror
/// image at y = 0.
struct ExampleShape {
  geometry::TriangleMesh mesh;
  Eigen::AlignedBox3d held;
};

/// dolphin (P1 Fig. 3), torus: both about a metre long.
const std::vector<std::string>& example_shapes();

/// \throw Refusal bad_option: no such shape
ExampleShape make_example_shape(const std::string& name);

}  // namespace tensegric_fit::virtual_body
