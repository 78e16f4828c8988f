/// Control mesh templates (P1 §3.3): nodes placed by landmark level and angle round the trunk. YAML.
#pragma once

#include <string>

namespace tensegric_fit::control_mesh {

struct Template {};

/// \throw Refusal bad_template naming file and key
Template load_template(const std::string& path);

}  // namespace tensegric_fit::control_mesh
