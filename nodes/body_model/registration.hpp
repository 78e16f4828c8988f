/// The model registered to a person's surface.
#pragma once

#include "body_model/displacement.hpp"
#include "body_model/registered_body.hpp"
#include "body_model/samples.hpp"

namespace tensegric_fit::body_model {

/// A model made ready for any number of registrations.
class Registrar {
 public:
  explicit Registrar(Model model);
  /// \param samples of one person, or of parts of her, within 15 degrees of upright (z up) \throw Refusal not_a_body
  RegisteredBody operator()(const Samples& samples) const;
  const Model& model() const { return *model_; }

 private:
  std::shared_ptr<const Model> model_;
  SkinField field_;
};

}  // namespace tensegric_fit::body_model
