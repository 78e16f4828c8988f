/// A fit as a 3D model for programs and pages.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::inspect {

/// A line of the garment: its middle before and worn (m), its lengths (m) and pull (pseudo force).
struct ModelLine {
  std::string name;
  std::vector<Eigen::Vector3d> before, after;
  double initial, final, tension;
};

/// A body before and under a garment, scan frame, metres. Only borrowed.
struct FitModel {
  const geometry::TriangleMesh& before;
  const std::vector<Eigen::Vector3d>& after;  ///< one per vertex of `before`; empty: no garment
  const std::vector<double>& distortion;      ///< the same
  const Eigen::Isometry3d& body_from_scan;
  std::vector<ModelLine> lines = {};
};

/// GLB, y up, facing +z, metres. Mesh `body`: coloured by distortion, with `_DISTORTION` per vertex and the
/// morph target `under the garment`; of each line a tube `line NAME` with the same morph target. \throw
/// Refusal as mesh_files::glb_bytes
std::string fit_glb(const FitModel& model);

}  // namespace tensegric_fit::inspect
