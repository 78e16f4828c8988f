/// Pictures of bodies without a display: lit, shaded by a colour a vertex (P1 Figs 5-8).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::inspect {

using Colour = std::array<std::uint8_t, 3>;  ///< RGB

/// One neutral colour for an undeformed body.
inline constexpr Colour kNeutral{200, 200, 200};

/// Fixed scale: distortion 1 is neutral, less (tighter) goes to red, more (looser) to blue; saturates at 0.7 and 1.3.
std::vector<Colour> distortion_colours(const std::vector<double>& distortion);

/// The same colours with a light baked in: rviz draws coloured triangle lists unlit.
std::vector<Colour> lit(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
                        const Eigen::Vector3d& light_direction);

/// Looks along `view` with `up` upwards, orthographic.
struct View {
  Eigen::Vector3d forward;  ///< unit, the way the camera looks, scan frame
  Eigen::Vector3d up;       ///< unit
  Eigen::Vector3d centre;   ///< in the middle of the picture
  double height;            ///< metres from the lower to the upper edge
};

/// BGR picture, z-buffered and lit. Lines (polylines in the scan frame) are drawn over it where they are visible.
struct Polyline {
  std::vector<Eigen::Vector3d> points;
  bool closed;
  Colour colour;
};
cv::Mat draw(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours, const std::vector<Polyline>& lines,
             const View& view, int width, int height);

}  // namespace tensegric_fit::inspect
