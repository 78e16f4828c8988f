/// The simulated body against the worn scan as a 3D model for a page.
#pragma once

#include <string>

#include "inspect/correlation_pictures.hpp"

namespace tensegric_fit::inspect {

/// Of `_DISTANCE`, m: here nothing is compared.
inline constexpr float kNotComparedDistance = 10;

/// GLB, y up, facing +z, metres. Mesh `body`: the body before, with the simulated one as its morph target,
/// coloured by distance, with `_DISTANCE` (m, positive: worn outside) per vertex; mesh `beside`: the worn
/// one. \throw Refusal as mesh_files::glb_bytes
std::string correlation_glb(const CorrelationScene& scene);

}  // namespace tensegric_fit::inspect
