#include "fit/tissue_file.hpp"

#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::fit {

void take_tissue(const std::string& path, Settings& settings) {
  namespace refusal = geometry::refusal;
  const char* const code = refusal::kBadOption;
  const YAML::Node file = geometry::load_yaml_map(path, code);
  std::vector<const char*> keys{"inner_nodes", "layers",      "uniform_stiffness", "thickness",
                                "beta",        "stiff_parts", "evidence"};
  for (const tensegric::ModelNumber& number : tensegric::kModelNumbers) keys.push_back(number.name);
  geometry::check_keys(file, keys, path, code);
  tensegric::ModelOptions& model = settings.model;
  const auto take = [&](const char* key, double& value, const geometry::Range& range) {
    if (file[key]) value = geometry::number_in(file, key, range.low, range.high, path, code);
  };
  model.inner = tensegric::inner_nodes_from(
      geometry::optional<std::string>(file, "inner_nodes", to_string(model.inner), path, code));
  double layers = model.layers;
  take("layers", layers, tensegric::kLayers);
  model.layers = geometry::optional(file, "layers", model.layers, path, code);
  model.uniform = geometry::optional(file, "uniform_stiffness", model.uniform, path, code);
  for (const tensegric::ModelNumber& number : tensegric::kModelNumbers)
    take(number.name, model.*number.field, number.range);
  if (file["stiff_parts"]) {
    model.stiff_parts.clear();
    for (const std::string& part :
         geometry::optional<std::vector<std::string>>(file, "stiff_parts", {}, path, code))
      model.stiff_parts.push_back(tensegric::stiff_part_from(part));
  }
  take("thickness", settings.control_mesh.thickness, control_mesh::kThickness);
  take("beta", settings.tffd.beta, geometry::kBetaOrNone);
}

}  // namespace tensegric_fit::fit
