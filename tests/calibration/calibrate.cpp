/// `calibrate CASES.yaml --out FILE.yaml`: the tissue's parameters from reference displacements, with the
/// evidence.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>

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
  const auto usual = geometry::optional<std::string>(node, "garment", "", path, kCode);
  for (const YAML::Node& reference : node["references"]) {
    geometry::check_keys(reference, {"ratio", "file", "garment", "tension"}, path, kCode);
    calibration::CalibrationCase one;
    const double ratio = geometry::number_in(reference, "ratio", tensegric::kLowestRatio, 1, path, kCode);
    const std::string worn = usual.empty()
                                 ? geometry::required<std::string>(reference, "garment", path, kCode)
                                 : geometry::optional(reference, "garment", usual, path, kCode);
    std::string variant = worn == usual ? "" : " " + fs::path(worn).stem().string();
    if (variant.rfind(" " + body.name + "_", 0) == 0) variant.erase(1, body.name.size() + 1);
    one.name = fmt::format("{}{} {:.3f}", body.name, variant, ratio);
    one.garment = tensegric::take_garment(beside(path, worn), geometry::shipped_folder("garments"));
    tensegric::set_ratio(one.garment, "", ratio);
    one.reference = calibration::read_reference(
        beside(path, geometry::required<std::string>(reference, "file", path, kCode)), body.body.mesh.mesh);
    one.newtons = geometry::optional<std::vector<double>>(reference, "tension", {}, path, kCode);
    if (!one.newtons.empty() && one.newtons.size() != one.garment.lines.size())
      throw geometry::Refusal(kCode, path + ": " + one.name + ": 'tension' needs one number a line");
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

struct Cases {
  std::vector<calibration::CalibrationBody> bodies;
  std::vector<control_mesh::Template> patterns;
  calibration::CalibrationOptions options;
};

Cases read_cases(const std::string& path, const fit::Settings& settings) {
  const YAML::Node file = geometry::load_yaml_map(path, kCode);
  geometry::check_keys(file, {"region", "fit", "bodies", "meshes"}, path, kCode);
  Cases cases;
  cases.options.fitted = geometry::optional(file, "fit", cases.options.fitted, path, kCode);
  std::set<std::string> regions;  // of the garments; the file may name one, too
  if (file["region"]) regions.insert(geometry::required<std::string>(file, "region", path, kCode));
  for (const YAML::Node& node : file["bodies"]) {
    cases.bodies.push_back(read_body(node, path, settings));
    for (const calibration::CalibrationCase& c : cases.bodies.back().cases)
      regions.insert(c.garment.regions.begin(), c.garment.regions.end());
  }
  if (file["meshes"]) {
    const std::vector<calibration::CalibrationBody> bodies = std::move(cases.bodies);
    cases.bodies.clear();
    for (const YAML::Node& mesh : file["meshes"]) {
      geometry::check_keys(mesh, {"control_triangles", "layers"}, path, kCode);
      const calibration::Fineness fineness{
          static_cast<int>(geometry::number_in(mesh, "control_triangles", 1, 100000, path, kCode)),
          static_cast<int>(geometry::number_in(mesh, "layers", tensegric::kLayers.low,
                                               tensegric::kLayers.high, path, kCode))};
      for (const calibration::CalibrationBody& body : bodies) {
        cases.bodies.push_back(body);
        cases.bodies.back().fineness = fineness;
      }
    }
  }
  for (const std::string& region : regions)
    cases.patterns.push_back(control_mesh::load_template(
        geometry::yaml_file(geometry::shipped_folder("templates"), region, kCode)));
  return cases;
}

// vertex, deformed place: a file for each case.
void write_fields(const std::string& folder, const calibration::CalibrationCase& one,
                  const calibration::CaseOutcome& out) {
  std::string name = one.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  std::ofstream file(fs::path(folder) / (name + ".csv"));
  file << "vertex,x,y,z\n";
  for (const int v : one.reference.vertices)
    file << fmt::format("{},{:.7f},{:.7f},{:.7f}\n", v, out.deformed[v].x(), out.deformed[v].y(),
                        out.deformed[v].z());
  if (!file.flush()) throw std::runtime_error(folder + ": cannot be written");
}

void print_errors(const Cases& cases, const fit::Settings& settings, const std::string& fields) {
  fmt::print("{:20s} {:>7s} {:>6s} {:>11s} {:>10s} {:>7s}  tension (reference, N)\n", "case", "still", "rms",
             "status", "iterations", "ms");
  for (const calibration::CalibrationBody& body : cases.bodies) {
    const auto outcomes = calibration::wear_cases(body, cases.patterns, settings, false);
    for (std::size_t c = 0; c < outcomes.size(); ++c) {
      const calibration::CalibrationCase& one = body.cases[c];
      const calibration::CaseOutcome& out = outcomes[c];
      if (!fields.empty()) write_fields(fields, one, out);
      fmt::print("{:20s} {:7.2f} {:6.2f} {:>11s} {:10d} {:7.1f}  {:.4g}", one.name,
                 1e3 * calibration::not_moving(one.reference), 1e3 * out.error, to_string(out.status),
                 out.iterations, out.milliseconds, fmt::join(out.tensions, " "));
      fmt::print(" ({:.4g})\n", fmt::join(one.newtons, " "));
    }
    std::fflush(stdout);
  }
}

void run(const Cases& cases, const std::string& out, const fit::Settings& settings) {
  const calibration::Calibration found =
      calibration::calibrate(cases.bodies, cases.patterns, settings, cases.options,
                             [](const std::string& what) { fmt::print(stderr, "{} ...\n", what); });
  const std::string text = fit::tissue_yaml(found.settings) +
                           evidence_of(found, cases.bodies, settings.control_mesh.control_triangles);
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
  app.add_option("cases", cases, "CASES.yaml: fit, bodies with mesh, garment and references")->required();
  app.add_option("--out", out, "Parameter file for fit --tissue")->capture_default_str();
  app.add_option("--tissue", tissue, "Where to begin, as a parameter file");
  app.add_option("--control-triangles", settings.control_mesh.control_triangles,
                 "Control triangles, at least")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  double beta = 0;
  app.add_option("--beta", beta, "Reach of t-FFD's triangles in their mean radii; 0: the tissue's")
      ->check(CLI::Range(0.0, 20.0));
  std::string fields;
  app.add_option("--fields", fields, "With --errors: a folder for each case's deformed skin, as CSV")
      ->check(CLI::ExistingDirectory);
  bool errors = false;
  app.add_flag("--errors", errors, "Fits nothing: errors, iterations and tensions by case, as things are");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (!tissue.empty()) fit::take_tissue(tissue, settings);
    if (beta != 0) settings.tffd.beta = beta;
    const Cases all = read_cases(cases, settings);
    if (errors)
      print_errors(all, settings, fields);
    else
      run(all, out, settings);
    return 0;
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "calibrate: {}\n", error.what());
    return 1;
  }
}
