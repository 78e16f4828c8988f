/// Whom the benchmarks dress, a body of the virtual booth or one from a file, and in what.
#pragma once

#include <string>

#include "geometry/control_mesh.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tensegric/solver.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::benchmarks {

inline const std::string kLaunch = TENSEGRIC_FIT_LAUNCH;  ///< folder of templates and garments

/// A body mesh to use from now on; empty: the virtual booth's. To be called before everything else here.
void choose_body(const std::string& ply_file);

/// Each is made once and kept. The true body; one from a file has no measures.
const virtual_body::VirtualBody& customer();

/// What the virtual booth sees of her, columns in register: what they are off is no matter of settings.
const geometry::PointCloud& scan(int points);

/// The body with that many triangles, or one less.
const geometry::TriangleMesh& body(int triangles);

/// Of the body only the skin that the bust's control mesh carries, cut finer to that many triangles.
const geometry::TriangleMesh& chest_skin(int triangles);

/// The bust's, with at least that many triangles: 60, or the shipped template's 120 and its subdivisions.
const geometry::ControlMesh& bust_control(int triangles);

const tensegric::Model& bust_model(int control_triangles);

/// Garment B1 at that ratio: a band on the body.
tensegric::Garment band(double ratio);

/// The same as a string over the control mesh, which needs no body: what solvers are compared with.
tensegric::Garment chest_line(double ratio);

/// From rest, by the equilibrium solver.
const tensegric::Solution& worn(int control_triangles, double ratio);

}  // namespace tensegric_fit::benchmarks
