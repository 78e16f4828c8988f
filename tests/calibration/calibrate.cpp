/// `calibrate CASES.yaml --out FILE.yaml`: the tissue's parameters from reference displacements or from
/// second scans with the garment on, with the evidence.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>

#include "calibration/calibration.hpp"
#include "correlation/correlate.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/checked_yaml.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "scan_files/scan_file.hpp"

namespace {

using namespace tensegric_fit;
namespace fs = std::filesystem;

constexpr const char* kCode = geometry::refusal::kBadOption;
constexpr int kCoarse = 120;  // control triangles that the default tissue is for; finer ones take fine.yaml

std::string beside(const fs::path& file, const std::string& name) {
  return fs::path(name).is_absolute() ? name : (file.parent_path() / name).string();
}

// A mesh or a scan, whichever of the two keys is there.
fit::Body body_in(const YAML::Node& node, const std::string& mesh, const std::string& scan,
                  const std::string& path, const fit::Settings& settings) {
  if (node[mesh].IsDefined() == node[scan].IsDefined())
    throw geometry::Refusal(kCode, fmt::format("{}: either '{}' or '{}' is needed", path, mesh, scan));
  fit::StageTimes times;
  if (node[scan]) {
    const scan_files::ScanFile file = scan_files::read_scan_file(
        beside(path, geometry::required<std::string>(node, scan.c_str(), path, kCode)));
    return fit::measure_scan(geometry::points_of(file.cloud), settings, times);
  }
  return fit::measure_mesh(
      geometry::read_ply_mesh(beside(path, geometry::required<std::string>(node, mesh.c_str(), path, kCode))),
      settings, times);
}

calibration::WornReference worn_in(const YAML::Node& node, const tensegric::Garment& garment,
                                   const fit::Body& bare, const std::string& path,
                                   const fit::Settings& settings) {
  std::vector<control_mesh::Template> patterns;
  for (const std::string& region : garment.regions)
    patterns.push_back(control_mesh::load_template(
        geometry::yaml_file(geometry::shipped_folder("templates"), region, kCode)));
  fit::StageTimes times;
  const double cloth = node["cloth"] ? geometry::number_in(node, "cloth", correlation::kThickness.low,
                                                           correlation::kThickness.high, path, kCode)
                                     : 0;
  return {bare, prepare(bare, patterns, settings, times).control,
          body_in(node, "worn", "worn_scan", path, settings), cloth};
}

calibration::CalibrationCase read_case(const YAML::Node& node, const std::string& usual,
                                       const calibration::CalibrationBody& body, const std::string& path,
                                       const fit::Settings& settings) {
  geometry::check_keys(node, {"ratio", "file", "garment", "tension", "worn", "worn_scan", "cloth"}, path,
                       kCode);
  const double ratio = geometry::number_in(node, "ratio", tensegric::kRatio.low, 1, path, kCode);
  const std::string garment = usual.empty() ? geometry::required<std::string>(node, "garment", path, kCode)
                                            : geometry::optional(node, "garment", usual, path, kCode);
  std::string variant = garment == usual ? "" : " " + fs::path(garment).stem().string();
  if (variant.rfind(" " + body.name + "_", 0) == 0) variant.erase(1, body.name.size() + 1);
  const std::string name = fmt::format("{}{} {:.3f}", body.name, variant, ratio);
  const bool is_file = fs::path(garment).has_extension();
  tensegric::Garment worn = tensegric::take_garment(is_file ? beside(path, garment) : garment,
                                                    geometry::shipped_folder("garments"));
  tensegric::set_ratio(worn, "", ratio);
  if (node["worn"] || node["worn_scan"]) {
    if (node["file"] || node["tension"])
      throw geometry::Refusal(kCode, path + ": " + name + ": a worn scan has neither 'file' nor 'tension'");
    calibration::WornReference reference = worn_in(node, worn, body.body, path, settings);
    return calibration::worn_case(name, std::move(worn), std::move(reference), body.body);
  }
  const auto newtons = geometry::optional<std::vector<double>>(node, "tension", {}, path, kCode);
  if (!newtons.empty() && newtons.size() != worn.lines.size())
    throw geometry::Refusal(kCode, path + ": " + name + ": 'tension' needs one number a line");
  return calibration::displaced_case(
      name, std::move(worn),
      calibration::read_reference(beside(path, geometry::required<std::string>(node, "file", path, kCode)),
                                  body.body.mesh.mesh),
      newtons);
}

calibration::CalibrationBody read_body(const YAML::Node& node, const std::string& path,
                                       const fit::Settings& settings) {
  geometry::check_keys(node, {"name", "mesh", "scan", "garment", "references"}, path, kCode);
  calibration::CalibrationBody body;
  body.name = geometry::required<std::string>(node, "name", path, kCode);
  body.body = body_in(node, "mesh", "scan", path, settings);
  const auto usual = geometry::optional<std::string>(node, "garment", "", path, kCode);
  for (const YAML::Node& reference : node["references"])
    body.cases.push_back(read_case(reference, usual, body, path, settings));
  if (body.cases.empty())
    throw geometry::Refusal(geometry::refusal::kTooFewData,
                            path + ": body " + body.name + " has no references");
  return body;
}

std::string today() {
  char date[16];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  return date;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

std::string evidence_of(const calibration::Calibration& found,
                        const std::vector<calibration::CalibrationBody>& bodies, int control_triangles) {
  std::string text = fmt::format("evidence:\n  date: {}\n  version: {}\n  control_triangles: {}\n", today(),
                                 TENSEGRIC_FIT_VERSION, control_triangles);
  text += fmt::format("  pull: {:.4g}\n", found.adjusted.pull);
  text +=
      "  errors_mm:  # root mean square over the free skin: not moving, before, fitted on all, left out\n";
  for (const calibration::CalibrationError& e : found.errors)
    text += fmt::format("    \"{}\": [{:.2f}, {:.2f}, {:.2f}, {:.2f}]\n", e.name, 1e3 * e.not_moving,
                        1e3 * e.before, 1e3 * e.in_sample, 1e3 * e.out_of_sample);
  text += "  left_out:\n";
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    text += fmt::format("    {}:\n", bodies[b].name);
    std::istringstream lines(calibration::tissue_yaml(found.left_out[b].settings));
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
  std::string text = "vertex,x,y,z\n";
  for (const int v : one.reference.vertices)
    text += fmt::format("{},{:.7f},{:.7f},{:.7f}\n", v, out.deformed[v].x(), out.deformed[v].y(),
                        out.deformed[v].z());
  write_text(fs::path(folder) / (name + ".csv"), text);
}

// By case the pull over the reference's, geometric mean of its lines.
using PullRatios = std::vector<std::pair<std::string, double>>;

double pull_ratio(const std::vector<double>& ours, const std::vector<double>& reference) {
  double sum = 0;
  for (std::size_t l = 0; l < reference.size(); ++l) sum += std::log(ours[l] / reference[l]);
  return std::exp(sum / static_cast<double>(reference.size()));
}

// What pages and panel show as a pull's uncertainty: a normal distribution of the logarithm round 0, as no
// pull is corrected by what is seen here.
std::string newtons_yaml(const PullRatios& ratios, int control_triangles) {
  constexpr double kTwoSided95 = 1.96;  // deviations
  double squares = 0;
  for (const auto& [name, ratio] : ratios) squares += std::pow(std::log(ratio), 2);
  const double half_width = kTwoSided95 * std::sqrt(squares / static_cast<double>(ratios.size()));
  const auto within = std::count_if(ratios.begin(), ratios.end(), [&](const auto& r) {
    return std::abs(std::log(r.second)) <= half_width;
  });
  std::string text = fmt::format(
      "# How near pulls are to the newtons of finite elements: `calibrate CASES --errors --newtons FILE` "
      "wrote "
      "this\n# (tests/calibration/README.md).\nmade: {}\ncontrol_triangles: {}\ncases: {}\nwithin: {}\n"
      "half_width: {:.2f}    # of a pull, 95 %\nratios:    # pull over the reference's\n",
      today(), control_triangles, ratios.size(), within, half_width);
  for (const auto& [name, ratio] : ratios) text += fmt::format("  \"{}\": {:.2f}\n", name, ratio);
  return text;
}

PullRatios print_errors(const Cases& cases, const fit::Settings& settings, const std::string& fields) {
  PullRatios ratios;
  fmt::print("{:20s} {:>7s} {:>6s} {:>11s} {:>10s} {:>7s}  tension (reference, N)\n", "case", "still", "rms",
             "status", "iterations", "ms");
  for (const calibration::CalibrationBody& body : cases.bodies) {
    const auto outcomes = calibration::wear_cases(body, cases.patterns, {settings}, false);
    for (std::size_t c = 0; c < outcomes.size(); ++c) {
      const calibration::CalibrationCase& one = body.cases[c];
      const calibration::CaseOutcome& out = outcomes[c];
      if (!fields.empty()) write_fields(fields, one, out);
      fmt::print("{:20s} {:7.2f} {:6.2f} {:>11s} {:10d} {:7.1f}  {:.4g}", one.name, 1e3 * one.still,
                 1e3 * out.error, to_string(out.status), out.iterations, out.milliseconds,
                 fmt::join(out.tensions, " "));
      fmt::print(" ({:.4g})\n", fmt::join(one.newtons, " "));
      if (!one.newtons.empty()) ratios.emplace_back(one.name, pull_ratio(out.tensions, one.newtons));
    }
    std::fflush(stdout);
  }
  return ratios;
}

calibration::Calibration fitted(const Cases& cases, const fit::Settings& settings) {
  return calibration::calibrate(cases.bodies, cases.patterns, {settings}, cases.options,
                                [](const std::string& what) { fmt::print(stderr, "{} ...\n", what); });
}

void write(const calibration::Calibration& found, const Cases& cases, int control_triangles,
           const std::string& out) {
  const std::string text =
      calibration::tissue_yaml(found.adjusted.settings) + evidence_of(found, cases.bodies, control_triangles);
  fmt::print("{}", text);
  write_text(out, text);
}

// Mean over the cases of the error left out, relative to not moving.
double left_out_error(const calibration::Calibration& found) {
  double sum = 0;
  for (const calibration::CalibrationError& e : found.errors) sum += e.out_of_sample / e.not_moving;
  return sum / static_cast<double>(found.errors.size());
}

// Force, thickness and density of the control mesh from worn scans (P2 §6): the first two fitted at each
// density, the density with the least error of pairs left out.
void run_worn(Cases cases, const std::string& out) {
  for (const calibration::CalibrationBody& body : cases.bodies)
    for (const calibration::CalibrationCase& one : body.cases)
      if (!one.worn)
        throw geometry::Refusal(kCode, one.name + ": --worn needs a worn scan, not displacements");
  cases.options.fitted = {"pull", "thickness"};
  const std::string fine = geometry::shipped_folder("tissue") + "/fine.yaml";
  std::optional<calibration::Calibration> best;
  int best_triangles = 0;
  fmt::print(
      "{:>9s} {:>6s} {:>9s}  root mean square distance to the worn skin, mm, means: not moving, before, "
      "fitted, left out\n",
      "triangles", "pull", "thickness");
  for (const int triangles : {kCoarse, 4 * kCoarse}) {  // the template's own and each split in four
    fit::Settings settings;
    if (triangles > kCoarse) fit::take_tissue(fine, settings);
    settings.control_mesh.control_triangles = triangles;
    const calibration::Calibration found = fitted(cases, settings);
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    for (const calibration::CalibrationError& e : found.errors)
      mean += Eigen::Vector4d(e.not_moving, e.before, e.in_sample, e.out_of_sample) /
              static_cast<double>(found.errors.size());
    fmt::print("{:9d} {:6.3f} {:9.3f}  {:.2f} {:.2f} {:.2f} {:.2f}\n", triangles, found.adjusted.pull,
               found.adjusted.settings.control_mesh.thickness, 1e3 * mean[0], 1e3 * mean[1], 1e3 * mean[2],
               1e3 * mean[3]);
    std::fflush(stdout);
    if (best && left_out_error(found) >= left_out_error(*best)) continue;
    best = found;
    best_triangles = triangles;
  }
  write(*best, cases, best_triangles, out);
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
  bool errors = false, worn = false;
  app.add_flag("--errors", errors, "Fits nothing: errors, iterations and tensions by case, as things are");
  std::string newtons;
  app.add_option("--newtons", newtons,
                 "With --errors: a file for how near pulls are to the references', as in launch/tissue")
      ->needs("--errors");
  app.add_flag("--worn", worn,
               "From pairs of scans, bare and worn: force, thickness and density of the control mesh")
      ->excludes("--errors")
      ->excludes("--tissue")
      ->excludes("--control-triangles")
      ->excludes("--beta");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (!tissue.empty()) fit::take_tissue(tissue, settings);
    if (beta != 0) settings.tffd.beta = beta;
    const Cases all = read_cases(cases, settings);
    if (errors) {
      const PullRatios ratios = print_errors(all, settings, fields);
      if (!newtons.empty() && ratios.empty())
        throw geometry::Refusal(geometry::refusal::kTooFewData, cases + ": no case has tensions");
      if (!newtons.empty())
        write_text(newtons, newtons_yaml(ratios, settings.control_mesh.control_triangles));
    } else if (worn)
      run_worn(all, out);
    else
      write(fitted(all, settings), all, settings.control_mesh.control_triangles, out);
    return 0;
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "calibrate: {}\n", error.what());
    return 1;
  }
}
