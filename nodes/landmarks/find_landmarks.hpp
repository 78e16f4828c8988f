/// Body mesh and the body model registered to it -> landmarks, heights, girths (ISO 8559-1 names;
/// README.md).
#pragma once

#include <vector>

#include "body_model/registered_body.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"
#include "landmarks/figures.hpp"

namespace tensegric_fit::landmarks {

/// What is known of every figure of a body before it is settled how much mesh and model count, in the body's
/// frame.
struct Reading {
  Eigen::Isometry3d body_from_scan;
  std::vector<Figure> figures;
  std::vector<geometry::Missing> missing;  ///< figures that were not found
};

/// `filled` is empty or has one flag per vertex: 1 where the scan saw nothing. `model`: registered to the
/// same person, in the mesh's frame. \throw Refusal bad_mesh, non_finite
Reading read_figures(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                     const body_model::RegisteredBody& model, const Precision& precision);

/// \throw Refusal as read_figures
geometry::BodyMeasures find_landmarks(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                                      const body_model::RegisteredBody& model, const Precision& precision);

}  // namespace tensegric_fit::landmarks
