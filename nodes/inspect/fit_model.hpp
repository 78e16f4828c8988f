/// A fit as a 3D model for programs and pages.
#pragma once

#include <string>

#include "inspect/fit_pictures.hpp"

namespace tensegric_fit::inspect {

/// GLB, body frame, y up. Mesh `body`: with colours by distortion, `_DISTORTION` per vertex and the morph
/// target `under_garment`; a tube `line N` (from 0) of each constraining line, with the same morph target.
/// \throw Refusal as mesh_files::glb_bytes
std::string fit_glb(const FitScene& scene);

}  // namespace tensegric_fit::inspect
