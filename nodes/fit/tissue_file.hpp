/// What a person's tissue is like, as a file: the parameters that `calibrate` finds and `fit --tissue` takes.
#pragma once

#include <string>

#include "fit/chain.hpp"

namespace tensegric_fit::fit {

/// The parameters of `settings` that say what tissue is like, as YAML: inner_nodes, layers, strut_stiffness,
/// lateral_stiffness, uniform_stiffness, skin, volume_stiffness, stiffening, modulus, prestress, thickness,
/// beta, stiff_parts (see ModelOptions, control_mesh::Options and tffd::Options): constants hold for the
/// reach that they were fitted with.
std::string tissue_yaml(const Settings& settings);

/// Puts the file's values in place of those of `settings`; what it does not name stays. A key `evidence` may
/// hold anything. \throw Refusal bad_option naming file and key: unknown, or its value out of range
void take_tissue(const std::string& path, Settings& settings);

}  // namespace tensegric_fit::fit
