/// Template + body + landmarks -> control mesh (P1 §3.3, P2 §3).
#pragma once

#include <optional>
#include <vector>

#include "body_model/registered_body.hpp"
#include "control_mesh/model_surface.hpp"
#include "control_mesh/skin.hpp"
#include "control_mesh/template.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/control_mesh.hpp"
#include "geometry/range.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::control_mesh {

inline constexpr geometry::Range kControlTriangles{1, 100000}, kThickness{0.2, 3};

/// Field defaults are the parameters' defaults.
struct Options {
  int control_triangles = 120;  ///< at least; the template is subdivided (x4) until it has that many
  double thickness = 1;         ///< of the soft tissue, times the template's (P2 §6)
};

/// What templates are laid on, in the body frame: made once for all templates of a body. For one thread: the
/// model's surface is made when a template first asks for it.
class BodySkin {
 public:
  /// \param measures must outlive it
  /// \param model registered to this body, in its frame; null: none, then no node may lie on it, and arms are
  /// not left out. Must outlive it
  /// \throw Refusal missing_part:trunk, not_a_body, non_finite, bad_mesh
  BodySkin(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
           const body_model::RegisteredBody* model);

  const geometry::BodyMeasures& measures() const { return measures_; }
  const Skin& skin() const { return skin_; }
  const ModelSurface* model() const;  ///< null: none

 private:
  const geometry::BodyMeasures& measures_;
  const Skin skin_;
  const body_model::RegisteredBody* const registered_;
  mutable std::optional<ModelSurface> model_;
};

/// Nodes at landmarks and on the rim lie on the skin, the others up to 3 mm off it: so the patch holds as
/// much as the body below it, within 2 %.
///
/// \param model registered to this body, in its frame; null: none, then no node may lie on it
/// \throw Refusal missing_part:LANDMARK, missing_part:body_model, not_a_body, non_finite, bad_mesh,
/// bad_option, bad_template: a point that the model does not have
geometry::ControlMesh fit_template(const Template& pattern, const geometry::TriangleMesh& body,
                                   const geometry::BodyMeasures& measures, const Options& options,
                                   const body_model::RegisteredBody* model = nullptr);

/// One for each of `options`, all from the same nodes: coarse and fine meshes of one body.
std::vector<geometry::ControlMesh> fit_template_for_each(const Template& pattern, const BodySkin& body,
                                                         const std::vector<Options>& options);

}  // namespace tensegric_fit::control_mesh
