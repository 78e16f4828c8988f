/// The body model that is shipped, for tests.
#pragma once

#include "body_model/registration.hpp"

namespace tensegric_fit::body_model {

inline const Model& model() {
  return shipped_registrar().model();
}

}  // namespace tensegric_fit::body_model
