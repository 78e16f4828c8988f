/// Screened Poisson surface reconstruction (Kazhdan and Hoppe 2013), by PCL.
#pragma once

#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// A surface around the points, as PCL leaves it: it can have bubbles and spots that are not manifold. Its
/// cells are as fine as the points are dense, down to `depth`. One at a time in a process, on one thread:
/// PCL's implementation keeps global state. What it prints to standard output is dropped. \pre float32
/// resolves the coordinates; unit normals
geometry::TriangleMesh poisson_surface(const geometry::PointCloud& cloud, int depth);

}  // namespace tensegric_fit::reconstruction
