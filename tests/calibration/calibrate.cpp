/// `calibrate CASES.yaml --out FILE.yaml`: the tissue's parameters from reference displacements or from
/// second scans with the garment on, with the evidence.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "calibration/cases_file.hpp"
#include "calibration/newtons_file.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"

namespace {

using namespace tensegric_fit;
using calibration::Cases;
using calibration::PullRatios;
namespace fs = std::filesystem;

constexpr int kCoarse = 120;  // control triangles that the default tissue is for; finer ones take fine.yaml

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

// As YAML takes any text.
std::string quoted(const std::string& text) {
  YAML::Emitter yaml;
  yaml << YAML::DoubleQuoted << text;
  return yaml.c_str();
}

std::string evidence_of(const calibration::Calibration& found,
                        const std::vector<calibration::CalibrationBody>& bodies, int control_triangles) {
  std::string text = fmt::format("evidence:\n  date: {}\n  version: {}\n  control_triangles: {}\n", today(),
                                 TENSEGRIC_FIT_VERSION, control_triangles);
  text += fmt::format("  pull: {:.4g}\n", found.adjusted.pull);
  text +=
      "  errors_mm:  # root mean square over the free skin: not moving, before, fitted on all, left out\n";
  for (const calibration::CalibrationError& e : found.errors)
    text += fmt::format("    {}: [{:.2f}, {:.2f}, {:.2f}, {:.2f}]\n", quoted(e.name), 1e3 * e.not_moving,
                        1e3 * e.before, 1e3 * e.in_sample, 1e3 * e.out_of_sample);
  text += "  left_out:\n";
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    text += fmt::format("    {}:\n", quoted(bodies[b].name));
    std::istringstream lines(calibration::tissue_yaml(found.left_out[b].settings));
    for (std::string line; std::getline(lines, line);) text += "      " + line + "\n";
  }
  return text;
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
      if (const auto ratio = calibration::pull_ratio(one, out)) ratios.emplace_back(one.name, *ratio);
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

// Force, thickness and density of the control mesh from worn scans (P2 §6): the first two fitted at each
// density, the density with the least error of pairs left out.
void run_worn(Cases cases, const std::string& out) {
  for (const calibration::CalibrationBody& body : cases.bodies)
    for (const calibration::CalibrationCase& one : body.cases)
      if (!one.worn)
        throw geometry::Refusal(geometry::refusal::kBadOption,
                                one.name + ": --worn needs a worn scan, not displacements");
  cases.options.fitted = {"pull", "thickness"};
  const std::string fine = geometry::shipped_folder("tissue") + "/fine.yaml";
  const std::vector<int> densities = {kCoarse, 4 * kCoarse};  // the template's own and each split in four
  std::vector<calibration::Calibration> all;
  fmt::print(
      "{:>9s} {:>6s} {:>9s}  root mean square distance to the worn skin, mm, means: not moving, before, "
      "fitted, left out\n",
      "triangles", "pull", "thickness");
  for (const int triangles : densities) {
    fit::Settings settings;
    if (triangles > kCoarse) fit::take_tissue(fine, settings);
    settings.control_mesh.control_triangles = triangles;
    all.push_back(fitted(cases, settings));
    const calibration::Calibration& found = all.back();
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    for (const calibration::CalibrationError& e : found.errors)
      mean += Eigen::Vector4d(e.not_moving, e.before, e.in_sample, e.out_of_sample) /
              static_cast<double>(found.errors.size());
    fmt::print("{:9d} {:6.3f} {:9.3f}  {:.2f} {:.2f} {:.2f} {:.2f}\n", triangles, found.adjusted.pull,
               found.adjusted.settings.control_mesh.thickness, 1e3 * mean[0], 1e3 * mean[1], 1e3 * mean[2],
               1e3 * mean[3]);
    std::fflush(stdout);
  }
  const std::size_t best = calibration::least_left_out(all);
  write(all[best], cases, densities[best], out);
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
  bool errors = false, worn = false;
  app.add_flag("--errors", errors, "Fits nothing: errors, iterations and tensions by case, as things are");
  std::string fields;
  app.add_option("--fields", fields, "With --errors: a folder for each case's deformed skin, as CSV")
      ->check(CLI::ExistingDirectory)
      ->needs("--errors");
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
    const Cases all = calibration::read_cases(cases, settings, worn);
    if (errors) {
      const PullRatios ratios = print_errors(all, settings, fields);
      if (!newtons.empty())
        write_text(newtons,
                   calibration::newtons_yaml(ratios, settings.control_mesh.control_triangles, today()));
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
