/// Lines as surfaces, which look right from every side and are hidden by what stands before them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "inspect/strokes.hpp"

namespace tensegric_fit::inspect {

/// One normal and one colour per vertex.
struct PaintedSurface {
  geometry::TriangleMesh mesh;
  std::vector<Eigen::Vector3d> normals;
  std::vector<Colour> colours;
};

/// A tube of that radius (m) round each stroke; strokes of less than two different points have none.
PaintedSurface tubes(const std::vector<Stroke>& strokes, double radius);

/// Strips from fibre to fibre, seen from both sides.
PaintedSurface surface_of(const std::vector<Ribbon>& ribbons);

}  // namespace tensegric_fit::inspect
