/// Values in the YAML files of cases.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <string>

namespace tensegric_fit::regression {

/// \throw Refusal bad_case beginning with `where`: not three numbers
Eigen::Vector3d vector_in(const YAML::Node& map, const char* key, const std::string& where);

/// Text in single quotes, as YAML reads it again.
std::string quoted(const std::string& text);

}  // namespace tensegric_fit::regression
