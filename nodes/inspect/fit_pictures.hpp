/// The pictures that `fit` writes (P1 Figs 5-8).
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"
#include "inspect/measured_picture.hpp"
#include "inspect/picture.hpp"

namespace tensegric_fit::inspect {

/// A part of the body that a garment changes.
struct Part {
  std::vector<Eigen::Vector3d> nodes;  ///< what the pictures are to show of it
  bool behind = false;                 ///< it is seen from behind
};

/// Of more, the whole body is shown as one: each row is two pictures.
inline constexpr std::size_t kMostRows = 8;

/// One per region of the control mesh; behind where most of its skin faces backwards.
std::vector<Part> parts_of(const geometry::ControlMesh& control, const Eigen::Isometry3d& body_from_scan);

/// The same of a control mesh whose regions are not known: one per connected piece.
std::vector<Part> parts_of(const geometry::TriangleMesh& control, const Eigen::Isometry3d& body_from_scan);

/// A body before and after. Only borrowed: the meshes and measures must outlive the scene.
struct FitScene {
  const geometry::TriangleMesh& before;
  const std::vector<Eigen::Vector3d>& after;                            ///< one per vertex of `before`
  const std::vector<double>& distortion;                                ///< one per vertex of `before`
  const geometry::BodyMeasures& measures;                               ///< for the frame
  std::vector<Part> parts;                                              ///< empty: the whole body
  std::vector<std::vector<Eigen::Vector3d>> lines_before, lines_after;  ///< constraining lines
  std::vector<int> warned = {};  ///< vertices of skin that there is a warning of: marked where it is worn
  /// shading_normals of both, where they are known: all pictures share them.
  std::vector<Eigen::Vector3d> normals_before = {}, normals_after = {};
};

/// Before on the left, after on the right (P1 Fig. 6, Fig. 7, Fig. 5): BGR, 1212 x 637. All \throw as draw()
cv::Mat front_picture(const FitScene& scene);
cv::Mat side_picture(const FitScene& scene);
cv::Mat back_picture(const FitScene& scene);

/// After, coloured by distortion, with the scale (P1 Fig. 8): BGR, 1212 wide. A row a part, of 600: from the
/// front and from an angle, or from behind.
cv::Mat distortion_picture(const FitScene& scene);

}  // namespace tensegric_fit::inspect
