/// What a model is registered to: oriented points spread over a surface.
#pragma once

#include <vector>

#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {

/// Points and outward unit normals, one per point; m, scan frame.
struct Samples {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
};

/// The same in a random order, always the same one for as many: any first n of them are spread over the
/// whole.
Samples shuffled(const Samples& samples);

/// The same, by where each one lies: a sample that is there or not, or moves a little, changes nothing of the
/// order of the others. Of scans, of which a rounding error may make one sample more.
Samples shuffled_by_place(const Samples& samples);

/// `count` points spread evenly over the mesh's area, as any first n of them are, the same for the same mesh;
/// those whose nearest corner is flagged in `filled` (empty, or one flag per vertex) are left out: no scan
/// point backs the surface there.
Samples sample_surface(const geometry::TriangleMesh& mesh, const std::vector<char>& filled, int count);

}  // namespace tensegric_fit::body_model
