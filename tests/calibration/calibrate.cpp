/// `calibrate CASES.yaml --out FILE.yaml`: the tissue's parameters from reference displacements, with the
/// evidence.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "calibration/calibration.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/checked_yaml.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"

namespace {

using namespace tensegric_fit;
namespace fs = std::filesystem;

constexpr const char* kCode = geometry::refusal::kBadOption;

std::string beside(const fs::path& file, const std::string& name) {
  return fs::path(name).is_absolute() ? name : (file.parent_path() / name).string();
}

calibration::CalibrationBody read_body(const YAML::Node& node, const std::string& path,
                                       const fit::Settings& settings) {
  geometry::check_keys(node, {"name", "mesh", "garment", "references"}, path, kCode);
  calibration::CalibrationBody body;
  body.name = geometry::required<std::string>(node, "name", path, kCode);
  fit::StageTimes times;
  body.body = fit::measure_mesh(
      geometry::read_ply_mesh(beside(path, geometry::required<std::string>(node, "mesh", path, kCode))),
      settings, times);
  const std::string usual = geometry::required<std::string>(node, "garment", path, kCode);
  for (const YAML::Node& reference : node["references"]) {
    geometry::check_keys(reference, {"ratio", "file", "garment"}, path, kCode);
    calibration::CalibrationCase one;
    const double ratio = geometry::number_in(reference, "ratio", tensegric::kLowestRatio, 1, path, kCode);
    const std::string worn = geometry::optional(reference, "garment", usual, path, kCode);
    one.name = fmt::format("{}{} {:.3f}", body.name,
                           worn == usual ? "" : " " + fs::path(worn).stem().string(), ratio);
    one.garment = tensegric::take_garment(beside(path, worn), geometry::shipped_folder("garments"));
    tensegric::set_ratio(one.garment, "", ratio);
    one.reference = calibration::read_reference(
        beside(path, geometry::required<std::string>(reference, "file", path, kCode)), body.body.mesh.mesh);
    body.cases.push_back(one);
  }
  if (body.cases.empty())
    throw geometry::Refusal(geometry::refusal::kTooFewData,
                            path + ": body " + body.name + " has no references");
  return body;
}

std::string evidence_of(const calibration::Calibration& found,
                        const std::vector<calibration::CalibrationBody>& bodies, int control_triangles) {
  char date[16];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  std::string text = fmt::format("evidence:\n  date: {}\n  version: {}\n  control_triangles: {}\n", date,
                                 TENSEGRIC_FIT_VERSION, control_triangles);
  text +=
      "  errors_mm:  # root mean square over the free skin: not moving, before, fitted on all, left out\n";
  for (const calibration::CalibrationError& e : found.errors)
    text += fmt::format("    \"{}\": [{:.2f}, {:.2f}, {:.2f}, {:.2f}]\n", e.name, 1e3 * e.not_moving,
                        1e3 * e.before, 1e3 * e.in_sample, 1e3 * e.out_of_sample);
  text += "  left_out:\n";
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    text += fmt::format("    {}:\n", bodies[b].name);
    std::istringstream lines(fit::tissue_yaml(found.left_out[b]));
    for (std::string line; std::getline(lines, line);) text += "      " + line + "\n";
  }
  return text;
}

void run(const std::string& cases, const std::string& out, fit::Settings settings) {
  const YAML::Node file = geometry::load_yaml_map(cases, kCode);
  geometry::check_keys(file, {"region", "fit", "bodies"}, cases, kCode);
  calibration::CalibrationOptions options;
  options.fitted = geometry::optional(file, "fit", options.fitted, cases, kCode);
  const std::vector<control_mesh::Template> patterns = {control_mesh::load_template(
      geometry::yaml_file(geometry::shipped_folder("templates"),
                          geometry::required<std::string>(file, "region", cases, kCode), kCode))};
  std::vector<calibration::CalibrationBody> bodies;
  for (const YAML::Node& node : file["bodies"]) bodies.push_back(read_body(node, cases, settings));
  const calibration::Calibration found =
      calibration::calibrate(bodies, patterns, settings, options,
                             [](const std::string& what) { fmt::print(stderr, "{} ...\n", what); });
  const std::string text =
      fit::tissue_yaml(found.settings) + evidence_of(found, bodies, settings.control_mesh.control_triangles);
  fmt::print("{}", text);
  std::ofstream written(out);
  written << text;
  if (!written.flush()) throw std::runtime_error(out + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Tissue parameters from reference displacements. Exit: 0 done, 2 usage, 3 refused, 1 not written.");
  std::string cases, out = "tissue.yaml", tissue;
  fit::Settings settings;
  app.add_option("cases", cases, "CASES.yaml: region, fit, bodies with mesh, garment and references")
      ->required();
  app.add_option("--out", out, "Parameter file for fit --tissue")->capture_default_str();
  app.add_option("--tissue", tissue, "Where to begin, as a parameter file");
  app.add_option("--control-triangles", settings.control_mesh.control_triangles,
                 "Control triangles, at least")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (!tissue.empty()) fit::take_tissue(tissue, settings);
    run(cases, out, settings);
    return 0;
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "calibrate: {}\n", error.what());
    return 1;
  }
}
