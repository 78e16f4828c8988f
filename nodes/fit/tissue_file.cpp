#include "fit/tissue_file.hpp"

#include <fmt/format.h>

#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::fit {

std::string tissue_yaml(const Settings& settings) {
  const tensegric::ModelOptions& model = settings.model;
  std::string parts;
  for (const tensegric::StiffPart& part : model.stiff_parts)
    parts += fmt::format("  - {}\n", to_string(part));
  return fmt::format(
             "inner_nodes: {}\nlayers: {}\nuniform_stiffness: {}\nstrut_stiffness: "
             "{:.4g}\nlateral_stiffness: "
             "{:.4g}\nskin: "
             "{:.4g}\nvolume_stiffness: "
             "{:.4g}\nstiffening: {:.4g}\nmodulus: {:.4g}\n"
             "prestress: {:.4g}\nthickness: {:.4g}\nbeta: {:.4g}\n",
             to_string(model.inner), model.layers, model.uniform, model.strut_stiffness,
             model.lateral_stiffness, model.skin, model.volume_stiffness, model.stiffening, model.modulus,
             model.prestress, settings.control_mesh.thickness, settings.tffd.beta) +
         (parts.empty() ? "" : "stiff_parts:\n" + parts);
}

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
