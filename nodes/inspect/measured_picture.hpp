/// A body with what was measured on it, for a check by eye.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"
#include "inspect/model_skin.hpp"

namespace tensegric_fit::inspect {

/// The registered model over its body. Only borrowed.
struct ModelOverlay {
  const ModelSkin& skin;
  const std::vector<unsigned char>& mesh_parts;  ///< one per vertex of the body: index into skin.parts
};

/// The whole body with its landmarks and the tapes of its girths, each with its name in a margin: BGR,
/// `height` pixels high. A ring is a landmark close behind other skin; what is farther behind is not drawn.
/// With `model` the skin is tinted by parts, and the model's edges lie over it as fine lines. `normals` as
/// for draw(). \throw Refusal as draw()
cv::Mat front_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                      int height = 900, const ModelOverlay* model = nullptr,
                      const std::vector<Eigen::Vector3d>& normals = {});
cv::Mat side_picture(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                     int height = 900, const ModelOverlay* model = nullptr,
                     const std::vector<Eigen::Vector3d>& normals = {});

}  // namespace tensegric_fit::inspect
