/// How a garment line lies over a body's skin.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::tffd {

/// Points along a line, 10 mm apart at most, each with the nearest skin. Metres.
struct LineOverSkin {
  std::vector<Eigen::Vector3d> feet;  ///< nearest points of the skin
  std::vector<int> below;             ///< the triangles that they lie in
  std::vector<double> heights;        ///< over the skin; 50 mm: that far from it, or farther
  std::vector<int> triangles;         ///< of the skin within 50 mm of the line
};

/// Empty where the line has no length, or no skin is near.
LineOverSkin line_over_skin(const std::vector<Eigen::Vector3d>& course,
                            const std::vector<Eigen::Vector3i>& triangles,
                            const std::vector<Eigen::Vector3d>& vertices);

/// Of line.triangles, those whose middles are within `reach` of one of `feet`, m.
std::vector<int> triangles_below(const LineOverSkin& line, const std::vector<Eigen::Vector3d>& feet,
                                 const std::vector<Eigen::Vector3i>& triangles,
                                 const std::vector<Eigen::Vector3d>& vertices, double reach);

}  // namespace tensegric_fit::tffd
