/// A reference displacement of a body's skin, as finite elements or a second scan give it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::calibration {

struct ReferenceField {
  std::vector<int> vertices;                   ///< of the body's mesh; those whose way is free
  std::vector<Eigen::Vector3d> displacements;  ///< one each, m
};

/// Reads CSV: a line `vertex,x,y,z,dx,dy,dz,fixed`, then a line a vertex: its number in the body's mesh, its
/// place at rest and its displacement (m), and 1 where it was held. \throw Refusal broken_file naming the
/// line; wrong_reference: it was made on another mesh; too_few_data: fewer than 100 free vertices
ReferenceField read_reference(const std::string& path, const geometry::TriangleMesh& body);

/// Root of the mean square distance (m) between `deformed` and where the reference has its free vertices.
double tissue_error(const ReferenceField& reference, const geometry::TriangleMesh& body,
                    const std::vector<Eigen::Vector3d>& deformed);

}  // namespace tensegric_fit::calibration
