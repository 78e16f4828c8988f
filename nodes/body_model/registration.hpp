/// The model registered to a person's surface.
#pragma once

#include "body_model/displacement.hpp"
#include "body_model/registered_body.hpp"
#include "body_model/samples.hpp"
#include "body_model/standing.hpp"

namespace tensegric_fit::body_model {

/// m, height of what can be registered. Tolerances: less of a person is too little to know her by, and what
/// is higher is not a person alone.
inline constexpr double kLowestPerson = 0.5, kHighestPerson = 2.15;

/// A model made ready for any number of registrations.
class Registrar {
 public:
  Registrar(Model model, const Standing& standing);
  /// \param samples of one person, or of parts of her, within 15 degrees of upright (z up), any first n of
  /// them spread over the whole \throw Refusal not_a_body
  RegisteredBody operator()(const Samples& samples) const;
  const Model& model() const { return *model_; }
  const std::shared_ptr<const Model>& shared_model() const { return model_; }
  const Standing& standing() const { return standing_; }

 private:
  std::shared_ptr<const Model> model_;
  SkinField field_;
  Standing standing_;
};

/// The model on a mesh; its lowest vertex is the ground, unless feet lack their soles (settled_ground) or are
/// not there. `filled`: empty, or one flag per vertex; where any is set the mesh was made of a scan without a
/// floor, as far as is known, and flagged skin shows nothing. Up as for a scan. \throw Refusal not_a_body
RegisteredBody register_mesh(const Registrar& registrar, const geometry::TriangleMesh& mesh,
                             const std::vector<char>& filled = {});

/// That of the shipped model, loaded once. \throw Refusal broken_file
const Registrar& shipped_registrar();

}  // namespace tensegric_fit::body_model
