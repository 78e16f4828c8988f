#include "geometry/checked_yaml.hpp"

#include <algorithm>
#include <set>
#include <string_view>

namespace tensegric_fit::geometry {

YAML::Node load_yaml_map(const std::string& path, const std::string& code) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw Refusal(code, path + ": cannot be read");
  } catch (const YAML::Exception& error) {
    throw Refusal(code, path + ": not YAML: " + error.what());
  }
  if (!root.IsMap()) throw Refusal(code, path + ": is not a YAML map");
  return root;
}

void check_keys(const YAML::Node& map, std::initializer_list<const char*> known, const std::string& where,
                const std::string& code) {
  if (!map.IsMap()) throw Refusal(code, where + ": must be a map");
  std::set<std::string> met;
  for (const auto& entry : map) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "(not a scalar)";
    const bool is_known =
        std::any_of(known.begin(), known.end(), [&key](std::string_view k) { return k == key; });
    if (!is_known) throw Refusal(code, where + ": unknown key '" + key + "'");
    if (!met.insert(key).second) throw Refusal(code, where + ": key '" + key + "' is given twice");
  }
}

double number_in(const YAML::Node& map, const char* key, double low, double high, const std::string& where,
                 const std::string& code) {
  const double value = required<double>(map, key, where, code);
  if (!(value >= low && value <= high))
    throw Refusal(code, where + ": '" + key + "' is " + map[key].Scalar() + ", outside [" +
                            std::to_string(low) + ", " + std::to_string(high) + "]");
  return value;
}

}  // namespace tensegric_fit::geometry
