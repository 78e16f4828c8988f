/// YAML maps whose keys and values are checked: unknown keys and values out of range are refused by name.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {

/// A file that must hold one YAML map. \throw Refusal `code`: not there, not YAML, not a map, a second
/// document that is not empty
YAML::Node load_yaml_map(const std::string& path, const std::string& code);

/// \throw Refusal `code` naming `where` and the first key of `map` that is not in `known` or is given twice
void check_keys(const YAML::Node& map, const std::vector<const char*>& known, const std::string& where,
                const std::string& code);

/// Value of `key`. \throw Refusal `code`: missing, or of another type
template <typename T>
T required(const YAML::Node& map, const char* key, const std::string& where, const std::string& code) {
  if (!map[key]) throw Refusal(code, where + ": key '" + key + "' is missing");
  try {
    return map[key].as<T>();
  } catch (const YAML::Exception&) {
    throw Refusal(code, where + ": the value of '" + key + "' has the wrong type");
  }
}

/// Value of `key`, or `fallback` where the key is not there. \throw Refusal `code`: of another type
template <typename T>
T optional(const YAML::Node& map, const char* key, const T& fallback, const std::string& where,
           const std::string& code) {
  return map[key] ? required<T>(map, key, where, code) : fallback;
}

/// A number in [low, high]. \throw Refusal `code` naming key, value and range
double number_in(const YAML::Node& map, const char* key, double low, double high, const std::string& where,
                 const std::string& code);

}  // namespace tensegric_fit::geometry
