/// The simulated body against the worn scan, to be looked at (P2 Fig. 12).
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "inspect/colours.hpp"
#include "inspect/fit_pictures.hpp"

namespace tensegric_fit::inspect {

/// Only borrowed. All meshes in one scan's frame, metres.
struct CorrelationScene {
  const geometry::TriangleMesh& simulated;
  const geometry::TriangleMesh& before;  ///< the same body at rest
  const geometry::TriangleMesh& worn;    ///< as aligned
  const std::vector<double>& distance;   ///< m, one per vertex of `simulated`; positive: worn outside
  const std::vector<char>& compared;     ///< one per vertex of `simulated`
  const Eigen::Isometry3d& body_from_scan;
  std::vector<Part> parts;  ///< what the garment changes
};

std::vector<Colour> distance_colours(const std::vector<double>& distance, const std::vector<char>& compared);

/// The simulated body coloured by distance, with the scale: one row per part, from the front and from an
/// angle, or from behind. BGR, 1512 wide. \throw Refusal as draw(); bad_mesh: not one distance a vertex
cv::Mat distance_picture(const CorrelationScene& scene);

/// Outlines from the front and from her left, one row per part: the worn body grey, where it is farther out
/// than the simulated one blue, where the simulated one is red, with the simulated outline dark and the
/// outline before dotted. BGR, 1512 wide. \throw as above
cv::Mat silhouette_picture(const CorrelationScene& scene);

}  // namespace tensegric_fit::inspect
