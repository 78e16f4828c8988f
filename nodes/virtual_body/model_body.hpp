/// Bodies of the product's own body model (nodes/body_model), posed and made smooth. They look like women and
/// stand as women stand, but a model that is registered to them can match them exactly: they are for
/// demonstrations and for tests of robustness, never evidence of accuracy.
#pragma once

#include <array>

#include "body_model/posed_model.hpp"
#include "virtual_body/catmull_clark.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::virtual_body {

/// Lengths in metres, angles in radians; arrays are left, right. Defaults: the mean woman.
struct ModelBodyParameters {
  Eigen::VectorXd shape;  ///< standard deviations, -4 to 4 each; as many as the model's components, or none
  double stature = 1.64;  ///< 1.40 to 2.00
  std::array<double, 2> arms{0.45, 0.45};    ///< 0.17 to 1.05, of each upper arm from hanging, to the side
  std::array<double, 2> forwards{0, 0};      ///< -0.5 to 0.5, of each upper arm
  std::array<double, 2> elbows{0.35, 0.35};  ///< 0 to 1, how far each is bent
  double legs = 0;   ///< -0.15 to 0.30, of each thigh to the side, from where it is at rest; soles stay level
  double lean = 0;   ///< -0.2 to 0.4, of the chest forwards
  double bend = 0;   ///< -0.2 to 0.2, of the chest to her right
  double twist = 0;  ///< -0.2 to 0.2, of the chest to her left
  double yaw = 0;    ///< -pi to pi, her facing in the scan's frame, from x towards y
  double tilt = 0;   ///< -0.26 to 0.26, her lean forward, soles and all
};

/// \throw Refusal bad_option naming the parameter, its value and its range
void check_parameters(const ModelBodyParameters& parameters);

/// A person of the model who stands on the floor z = 0, in the body frame.
struct StandingModel {
  body_model::Parameters parameters;      ///< model axes -> body frame
  std::vector<Eigen::Vector3d> vertices;  ///< of the model's skin
};
StandingModel stand(const body_model::Model& model, const ModelBodyParameters& parameters);

/// What of her is in the way of what.
struct Collisions {
  bool arms[2];  ///< the left, the right arm with anything else
  bool legs;     ///< with each other
};
Collisions collisions(const body_model::Model& model, const std::vector<Eigen::Vector3d>& vertices);

/// The mesh is closed and outward, some 107,000 triangles: the model's skin after `subdivisions` steps of
/// Catmull and Clark. Truth is measured on it. \throw Refusal bad_option: a parameter out of range, an arm
/// that runs into the body
VirtualBody make_body(const body_model::Model& model, const ModelBodyParameters& parameters,
                      int subdivisions = 1);

/// Index into the model's bones. \throw std::out_of_range: it has none of that name
int bone_named(const body_model::Model& model, const std::string& name);

/// The shipped model, loaded once. \throw Refusal broken_file
const body_model::Model& shipped_model();

}  // namespace tensegric_fit::virtual_body
