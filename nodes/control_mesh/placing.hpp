/// Lays a template's nodes on the skin.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "control_mesh/model_surface.hpp"
#include "control_mesh/skin.hpp"
#include "control_mesh/template.hpp"
#include "geometry/body_measures.hpp"

namespace tensegric_fit::control_mesh {

/// A vertical line inside the trunk, in the body frame: angles and levels are seen from it.
/// \throw Refusal missing_part:LANDMARK
Eigen::Vector3d trunk_axis(const Template& pattern, const geometry::BodyMeasures& measures);

/// Which of a template's places count.
enum class Layout {
  as_drawn,
  over_folds,  ///< nodes at a landmark's own level that would lie below a fold go above it: for breasts whose
               ///< fold is at bust level
  on_model     ///< nodes with `or_on_model` lie there, but for those at landmarks that were found
};

/// Positions of all nodes on the skin, body frame. `model` is not null where the template needs one or the
/// layout is on_model. \throw Refusal missing_part:LANDMARK, not_a_body, bad_template: a point that the
/// model does not have
std::vector<Eigen::Vector3d> place_nodes(const Template& pattern, const geometry::BodyMeasures& measures,
                                         const Skin& skin, Layout layout = Layout::as_drawn,
                                         const ModelSurface* model = nullptr);

}  // namespace tensegric_fit::control_mesh
