/// Triangles to pixels: which triangle is in front at each pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace tensegric_fit::inspect {

/// One entry per pixel. Depth grows away from the camera.
struct Raster {
  cv::Mat1f depth;     ///< infinity where there is nothing
  cv::Mat1i triangle;  ///< -1 where there is nothing
};

/// `points` are in pixels (x to the right, y down; pixel (i, j) covers [i, i+1) x [j, j+1)), z is depth.
/// Of two triangles at one depth one that faces the camera stays (normals outward), of two alike the first.
Raster rasterise(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
                 int width, int height);

/// Barycentric coordinates in the picture plane. \pre the triangle has an area there
Eigen::Vector3d picture_barycentric(const Eigen::Vector2d& pixel, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace tensegric_fit::inspect
