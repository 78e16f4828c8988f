/// population: bodies drawn by lot, scanned, measured, fitted with control meshes and compared with what is
/// known of them. Prints a line a body with what fails and why, then how each measure does against ISO 20685.
/// Exit 0 where every measure holds on 95 % of the bodies.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

#include "booth/assembler.hpp"
#include "booth/random_body.hpp"
#include "booth/virtual_body.hpp"
#include "booth/virtual_scanner.hpp"
#include "comparison.hpp"
#include "control_check.hpp"
#include "fit/chain.hpp"
#include "geometry/status.hpp"

namespace {

using namespace tensegric_fit;

constexpr double kShareAsked = 0.95;

/// Every body is refused with a name or measured.
struct Result {
  std::vector<population::Error> errors;
  std::string refusal;
};

/// What of a customer is measured.
enum class Input { surface, merged_scan, assembled_scan };

// As the assembler node has it: each sensor's cloud in its own frame.
geometry::PointCloud assembled(const booth::VirtualScan& scan, int sensors_per_column) {
  booth::Capture capture{0, 0, {}};
  std::vector<Eigen::Isometry3d> booth_from_sensor;
  for (booth::SensorScan& sensor : booth::by_sensor(scan)) {
    booth_from_sensor.push_back(sensor.pose.booth_from_sensor);
    for (Eigen::Vector3d& p : sensor.cloud.points) p = booth_from_sensor.back().inverse() * p;
    const auto cloud = std::make_shared<booth::SensorCloud>();
    cloud->cloud = std::move(sensor.cloud);
    capture.clouds.push_back(cloud);
  }
  booth::AssemblerOptions options;
  options.sensors_per_column = sensors_per_column;
  return booth::assemble(capture, booth_from_sensor, options).cloud;
}

fit::Body measured_body(const booth::VirtualBody& body, int seed, Input input) {
  fit::StageTimes times;
  if (input == Input::surface) return fit::measure_mesh(body.mesh, {}, times);
  const booth::ScannerOptions scanner = booth::random_scanner(seed, body);
  const booth::VirtualScan scan = booth::scan_body(body.mesh, scanner);
  return fit::measure_scan(
      input == Input::merged_scan ? scan.cloud : assembled(scan, scanner.sensors_per_column), {}, times);
}

Result measure(const booth::VirtualBody& body, int seed, Input input,
               const std::vector<control_mesh::Template>& patterns) {
  try {
    const fit::Body measured = measured_body(body, seed, input);
    const bool has_waist = body.waist_method.find("ruler") == std::string::npos;
    Result result{population::errors_of(measured.measures, body.truth, has_waist), ""};
    for (const control_mesh::Template& pattern : patterns)
      for (const population::Error& error :
           population::control_errors(pattern, measured.mesh.mesh, measured.measures))
        result.errors.push_back(error);
    return result;
  } catch (const geometry::Refusal& refusal) {
    return {{}, fmt::format("{}: {}", refusal.code(), refusal.what())};
  }
}

// Where a measure fails on the true surface too, the scan is not to blame.
void tell_scan_from_shape(const booth::VirtualBody& body, int seed, Result& result) {
  const auto fails = [](const population::Error& error) { return !error.within(); };
  if (std::none_of(result.errors.begin(), result.errors.end(), fails)) return;
  const Result on_surface = measure(body, seed, Input::surface, {});
  for (population::Error& error : result.errors) {
    if (!fails(error)) continue;
    for (const population::Error& same : on_surface.errors)
      if (same.measure == error.measure)
        error.cause += fmt::format("{}{}", error.cause.empty() ? "" : "; ",
                                   fails(same) ? "on the true surface too" : "on the scan only");
  }
}

std::string description(const booth::BodyParameters& p, const booth::VirtualBody& body) {
  std::string girths;
  for (const geometry::Measure& girth : body.truth.girths)
    if (girth.name == "bust" || girth.name == "underbust" || girth.name == "hip")
      girths += fmt::format(" {} {:.2f}", girth.name, girth.metres);
  return fmt::format("stature {:.2f}{} firmness {:.1f} belly {:.1f} arms {:.0f} stoop {:.0f} tilt {:.0f}",
                     p.stature, girths, p.firmness, p.belly, p.arm_angle * 180 / M_PI, p.stoop * 180 / M_PI,
                     p.tilt * 180 / M_PI);
}

std::string failures(const std::vector<population::Error>& errors) {
  std::string text;
  for (const population::Error& e : errors)
    if (!e.within())
      text += fmt::format("; {} {:+.1f}{}", e.measure, e.millimetres,
                          e.cause.empty() ? "" : " (" + e.cause + ")");
  return text.empty() ? "; all within" : text;
}

int run(int first, int count, Input input) {
  std::vector<control_mesh::Template> patterns;
  for (const char* name : {"bust", "hips"})
    patterns.push_back(
        control_mesh::load_template(fmt::format("{}/templates/{}.yaml", TENSEGRIC_FIT_LAUNCH, name)));
  std::vector<std::vector<population::Error>> bodies;
  std::vector<int> seeds;
  std::map<std::string, std::vector<int>> refusals;
  for (int seed = first; seed < first + count; ++seed) {
    const booth::BodyParameters parameters = booth::random_body(seed);
    const booth::VirtualBody body = booth::make_body(parameters);
    Result result = measure(body, seed, input, patterns);
    if (input != Input::surface) tell_scan_from_shape(body, seed, result);
    std::cout << fmt::format("{} {}{}\n", seed, description(parameters, body),
                             result.refusal.empty() ? failures(result.errors) : "; " + result.refusal)
              << std::flush;
    if (!result.refusal.empty()) {
      refusals[result.refusal].push_back(seed);
      continue;
    }
    bodies.push_back(result.errors);
    seeds.push_back(seed);
  }

  bool holds = refusals.empty();
  std::cout << fmt::format("\n{:<20} {:>6} {:>9} {:>16} {:>7} {:>8} {:>8}  {}\n", "measure, mm", "limit",
                           "within", "mean +- 95 %", "median", "largest", "missing", "worst seed");
  for (const population::Row& row : population::summary(bodies, seeds)) {
    const bool enough =
        row.within >= kShareAsked * row.bodies && std::abs(row.mean) + row.interval <= row.limit;
    holds = holds && enough;
    std::cout << fmt::format("{:<20} {:>6} {:>4}/{:<4} {:>8.2f} +- {:<4.2f} {:>7.2f} {:>8.1f} {:>8}  {}{}\n",
                             row.measure, row.limit, row.within, row.bodies, row.mean, row.interval,
                             row.median, row.largest, row.missing, row.worst, enough ? "" : "  short");
  }
  for (const auto& [refusal, refused] : refusals)
    std::cout << fmt::format("refused {} of {}, first seed {}: {}\n", refused.size(), count, refused.front(),
                             refusal);
  return holds ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  int first = 1, count = 20;
  bool mesh_only = false, merged = false;
  CLI::App app("Measures bodies drawn by lot and compares with their truth.");
  app.option_defaults()->always_capture_default();
  app.add_option("--first", first, "first seed")->check(CLI::NonNegativeNumber);
  app.add_option("--bodies", count, "how many")->check(CLI::PositiveNumber);
  auto* surface = app.add_flag("--mesh-only", mesh_only, "the true surface: what landmarks alone do wrong");
  app.add_flag("--merged", merged, "clouds as they come, columns not moved onto each other")
      ->excludes(surface);
  CLI11_PARSE(app, argc, argv);
  return run(first, count, mesh_only ? Input::surface : merged ? Input::merged_scan : Input::assembled_scan);
}
