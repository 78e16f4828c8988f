/// Pictures of bodies without a display: lit, shaded by a colour a vertex (P1 Figs 5-8).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {

/// Looks along `forward` with `up` upwards, orthographic.
struct View {
  Eigen::Vector3d forward;  ///< unit, the way the camera looks, scan frame
  Eigen::Vector3d up;       ///< unit, square to `forward`
  Eigen::Vector3d centre;   ///< in the middle of the picture
  double height;            ///< metres from the lower to the upper edge
};

/// Views of a person; `body_from_scan` takes the scan's frame to the body's. `height` in metres.
View front_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height);
/// Her left profile: she looks to the left edge.
View side_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height);
/// From before her, her left and a little above (P1 Fig. 5).
View oblique_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height);

View back_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height);
/// From behind her, her left and a little above.
View oblique_back_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height);

using MakeView = View (*)(const Eigen::Isometry3d&, const Eigen::Vector3d&, double);

/// The square that holds the points, `margin` times as large as they need.
View framed(MakeView make, const Eigen::Isometry3d& body_from_scan,
            const std::vector<Eigen::Vector3d>& points, double margin);

/// A line in the scan's frame, drawn where it is visible.
struct Polyline {
  std::vector<Eigen::Vector3d> points;
  bool closed;
  Colour colour;
  double width = 0.003;  ///< m; 0: as fine as a picture can show
};

/// BGR picture on white: z-buffered, smoothly shaded by a light above the camera. Lines lie over the skin;
/// what is hidden behind more than a few millimetres of body is not drawn. `colours` has one per vertex, or
/// is empty: all neutral. `normals`: shading_normals of the mesh where they are known, else empty. \throw
/// Refusal bad_mesh: colours or normals do not fit; bad_option: a picture without size
cv::Mat draw(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
             const std::vector<Polyline>& lines, const View& view, int width, int height,
             const std::vector<Eigen::Vector3d>& normals = {});

/// What the mesh covers of such a picture: 255, else 0. \throw Refusal as draw()
cv::Mat1b silhouette(const geometry::TriangleMesh& mesh, const View& view, int width, int height);

/// Where a point comes to lie in a picture.
struct SeenPoint {
  Eigen::Vector2d pixel;
  double behind;  ///< metres of body in front of it; 0 or less where it can be seen, or lies outside
};

/// One per point; view, width and height as for the picture. \throw Refusal as draw()
std::vector<SeenPoint> seen_points(const geometry::TriangleMesh& mesh,
                                   const std::vector<Eigen::Vector3d>& points, const View& view, int width,
                                   int height);

}  // namespace tensegric_fit::inspect
