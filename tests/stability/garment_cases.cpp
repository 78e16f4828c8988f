#include <algorithm>
#include <filesystem>
#include <map>

#include "control_mesh/fit_template.hpp"
#include "fit/chain.hpp"
#include "stability_case.hpp"
#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/random_body.hpp"

namespace tensegric_fit::stability {
namespace {

namespace fs = std::filesystem;

const std::string kLaunch = TENSEGRIC_FIT_SOURCE_DIR "/launch/";

virtual_body::BodyParameters parameters_of(const std::string& body) {
  virtual_body::BodyParameters parameters;  // firm: mannequin-like, symmetric
  if (body == "average") {
    parameters.firmness = 0.6;
    parameters.asymmetry = 0.06;
    parameters.waist = 1.1;
    parameters.hip = 1.05;
  } else if (body == "full") {
    parameters.bust = 1.15;
    parameters.firmness = 0.4;
    parameters.asymmetry = -0.08;
    parameters.waist = 1.3;
    parameters.hip = 1.15;
  }
  return parameters;
}

fit::Body measured(const virtual_body::BodyParameters& parameters) {
  fit::StageTimes times;
  return fit::measure_mesh(virtual_body::make_body(parameters).mesh, {}, times);
}

std::vector<std::string> yaml_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// As the chain lays it: with the body model registered to the body.
geometry::ControlMesh lay_on(const control_mesh::Template& pattern, const fit::Body& body) {
  return control_mesh::fit_template(pattern, body.mesh.mesh, body.measures, {}, &*body.model);
}

/// The pieces of control mesh that the regions need, on the body.
fit::Fitting dressed(const fit::Body& body, const std::vector<std::string>& regions) {
  std::vector<geometry::ControlMesh> pieces;
  for (const std::string& file : yaml_files(kLaunch + "templates")) {
    const control_mesh::Template pattern = control_mesh::load_template(file);
    const bool wanted = std::any_of(
        pattern.regions.begin(), pattern.regions.end(), [&](const control_mesh::TemplateRegion& r) {
          return std::find(regions.begin(), regions.end(), r.name) != regions.end();
        });
    if (wanted) pieces.push_back(lay_on(pattern, body));
  }
  fit::StageTimes times;
  return fit::prepare(body, pieces.size() == 1 ? pieces.front() : geometry::joined(pieces), {}, times);
}

}  // namespace

std::vector<geometry::ControlMesh> template_meshes(std::uint64_t seed) {
  const fit::Body body = measured(virtual_booth::random_body(seed));
  std::vector<geometry::ControlMesh> meshes;
  for (const std::string& file : yaml_files(kLaunch + "templates"))
    meshes.push_back(lay_on(control_mesh::load_template(file), body));
  return meshes;
}

std::vector<Case> garment_cases(const std::string& name, const std::vector<double>& ratios) {
  const fit::Body body = measured(parameters_of(name));
  std::map<std::vector<std::string>, fit::Fitting> fittings;
  std::vector<Case> cases;
  for (const std::string& file : yaml_files(kLaunch + "garments")) {
    const tensegric::Garment garment = tensegric::load_garment(file);
    if (fittings.count(garment.regions) == 0)
      fittings.emplace(garment.regions, dressed(body, garment.regions));
    const fit::Fitting& fitting = fittings.at(garment.regions);
    const std::vector<geometry::LaidLine> laid = fit::laid_lines(body, fitting, garment);
    for (double ratio : ratios) {
      Case all;
      all.control = fitting.control;
      all.garment = garment;
      all.laid = laid;
      set_ratio(all.garment, "", ratio);
      const std::string at = " at " + std::to_string(ratio).substr(0, 4);
      all.name = "garments/" + name + " body, " + garment.name + at;
      cases.push_back(all);
      if (garment.lines.size() < 2) continue;
      for (const tensegric::GarmentLine& line : garment.lines) {
        Case one = all;
        set_ratio(one.garment, "", 1);
        set_ratio(one.garment, line.name, ratio);
        one.name = "garments/" + name + " body, " + garment.name + ", " + line.name + at;
        cases.push_back(one);
      }
    }
  }
  return cases;
}

}  // namespace tensegric_fit::stability
