/// What was registered: whether it is a person, and what is there besides her.
#pragma once

#include <vector>

#include "body_model/registered_body.hpp"
#include "body_model/samples.hpp"

namespace tensegric_fit::body_model {

inline constexpr double kOff = 0.035;  ///< m from the skin: more than the model misses women by
inline constexpr double kLeastThing =
    0.004;  ///< of the surface, 70 cm^2: more than fingers that are bent otherwise

/// Fills `evidence`, `unexplained` and `note`. Returns of each sample that was looked at, the first ones,
/// whether it is of a thing that is not hers. \pre samples in random order; the body is registered to them
/// \throw Refusal not_a_body: no person's shape or size, or more than one person
std::vector<char> recognise(RegisteredBody& body, const Samples& samples);

}  // namespace tensegric_fit::body_model
