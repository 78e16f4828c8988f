/// Small control meshes, good and bad, for the hard cases.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "tensegric/solver.hpp"

namespace tensegric_fit::stability {

/// One region "shape" over all triangles; inner nodes `thickness` below along the vertex normals, all nodes
/// free.
geometry::ControlMesh control_of(const geometry::TriangleMesh& mesh, double thickness);

/// A sheet of columns x rows quads, 20 mm each, in the plane z = 0, its rim fixed, 10 mm thick, moved by
/// `shape`.
geometry::ControlMesh sheet(int columns, int rows,
                            const std::function<Eigen::Vector3d(Eigen::Vector3d)>& shape);

/// Closed, with a hole: `around` x `across` quads, radii 100 mm and 40 mm. Fixed where x < -80 mm.
geometry::ControlMesh torus(int around, int across);

/// Fixes outer and inner nodes where `held` says so of the outer one, and frees the others.
void hold(geometry::ControlMesh& control, const std::function<bool(int)>& held);

/// A garment of one line over the nodes' names; the nodes get names where they have none.
tensegric::Garment line_over(geometry::ControlMesh& control, const std::vector<int>& nodes, double ratio);

/// The bust of tests/unit with its garment B1.
tensegric::Garment chest(double ratio);

}  // namespace tensegric_fit::stability
