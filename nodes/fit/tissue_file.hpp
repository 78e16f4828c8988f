/// What a person's tissue is like, as a file: the parameters that `calibrate` finds and `fit --tissue` takes.
#pragma once

#include <string>

#include "fit/chain.hpp"

namespace tensegric_fit::fit {

/// Puts the file's values (fields of tensegric::ModelOptions, `thickness` of control_mesh::Options, `beta` of
/// tffd::Options) in place of those of `settings`; what it does not name stays. A key `evidence` may hold
/// anything. \throw Refusal bad_option naming file and key: unknown, or its value out of range
void take_tissue(const std::string& path, Settings& settings);

}  // namespace tensegric_fit::fit
