/// Distortion of the deformed skin (P1 Fig. 8; README.md).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tffd/binding.hpp"

namespace tensegric_fit::tffd {

/// At each control vertex: area of the triangles around it, after / before. 1 where nothing changed and where
/// a vertex has no triangle. Before: at rest in the posture in which it is worn, so that a posture distorts
/// nothing. \throw Refusal bad_mesh: another number of nodes than was bound
std::vector<double> control_distortion(const Binding& binding, const std::vector<Eigen::Vector3d>& outer);

/// The same at each body vertex: a mean over the control vertices around it (Weights::values), brought to 1
/// as the skin's share of the motion goes to 0. Exactly 1 where the body cannot be moved. \throw Refusal
/// bad_mesh: not one value a control vertex
std::vector<double> body_distortion(const Binding& binding, const std::vector<double>& at_control_vertices);

}  // namespace tensegric_fit::tffd
