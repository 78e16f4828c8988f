#include "yaml_values.hpp"

#include <vector>

#include "case.hpp"
#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::regression {

Eigen::Vector3d vector_in(const YAML::Node& map, const char* key, const std::string& where) {
  const auto values = geometry::required<std::vector<double>>(map, key, where, kBadCase);
  if (values.size() != 3) throw geometry::Refusal(kBadCase, where + ": '" + key + "' is not [x, y, z]");
  return {values[0], values[1], values[2]};
}

std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? "''" : std::string(1, letter);
  return quoted + "'";
}

}  // namespace tensegric_fit::regression
