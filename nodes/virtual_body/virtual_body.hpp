/// A female body with known landmarks, heights and girths: what the virtual booth scans.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::virtual_body {

/// Of the implicit family. Field defaults are the parameters' defaults: a slim, symmetric woman of 1.70 m.
/// Lengths in metres, angles in radians.
struct BodyParameters {
  double stature = 1.70;    ///< 1.40 to 2.00; the whole body scales with it
  double build = 1.0;       ///< 0.85 to 1.50, thickness of trunk and limbs relative to the default
  double bust = 1.0;        ///< 0.75 to 1.50, size of the breasts as a length, relative to the default
  double firmness = 0.8;    ///< -0.8 to 1; less lets the breasts sag, below 0 they hang over their folds
  double asymmetry = 0.0;   ///< -0.2 to 0.2; by how much the left breast is larger than the right
  double waist = 1.0;       ///< 0.90 to 1.40, thickness of the trunk at the waist, relative to the default
  double belly = 0.0;       ///< 0 to 1, how round it is; 1 stands out by 75 mm
  double hip = 1.0;         ///< 0.90 to 1.25, thickness of hips and upper thighs, relative to the default
  double arm_angle = 0.40;  ///< 0.25 to 1.40, between the upper arms and the vertical
  double stoop = 0.0;       ///< -0.1 to 0.4, how far the spine bends forward above the waist
  double yaw = 0.0;         ///< -pi to pi, her facing in the scan's frame, from x towards y
  double tilt = 0.0;        ///< -0.26 to 0.26 (15 degrees), her lean forward
};

/// \throw Refusal bad_option naming the parameter, its value and its range
void check_parameters(const BodyParameters& parameters);

/// What the definitions of the measures leave open on a body. Names: "girth waist", "height hip", "point
/// shoulder_L".
struct Doubts {
  std::vector<std::string> vague;   ///< figures that their definition does not settle
  std::vector<std::string> hidden;  ///< figures at a place that no sensor sees
  std::vector<std::pair<std::string, Eigen::Vector3d>>
      loose;  ///< landmarks with a direction along which they are open
};

/// The mesh is closed, manifold and outward, about 110,000 triangles, in the scan's frame, soles on z = 0.
struct VirtualBody {
  geometry::TriangleMesh mesh;
  /// All confidences are 1. Besides the usual names: heights waist_ruler, hip_max_girth, bust_max; girths
  /// bust_max, waist_ruler, hip_max; landmarks fold_lowest_L/R.
  geometry::BodyMeasures truth;
  Doubts doubts;
  std::string waist_method;  ///< how the waist's height was chosen: by the girth's minimum, or "ruler level"
                             ///< without one
  std::string family;        ///< "implicit" or "model"
  std::vector<std::pair<std::string, double>> parameters;  ///< that it was made from, by name
  std::vector<double> shape;  ///< of the model family: coefficients of the body model, standard deviations
};

/// A body of the implicit family; with asymmetry, yaw and tilt 0 it is its own mirror image in y, bit for
/// bit. \throw Refusal bad_option: a parameter out of range, or arms that touch the trunk
VirtualBody make_body(const BodyParameters& parameters);

}  // namespace tensegric_fit::virtual_body
