#include "calibration/cases_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "correlation/correlate.hpp"
#include "geometry/checked_yaml.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "scan_files/scan_file.hpp"

namespace tensegric_fit::calibration {
namespace {

using geometry::Refusal;
namespace fs = std::filesystem;

constexpr const char* kCode = geometry::refusal::kBadOption;

std::string beside(const fs::path& file, const std::string& name) {
  return fs::path(name).is_absolute() ? name : (file.parent_path() / name).string();
}

fit::Body scanned_body(const std::string& file, const fit::Settings& settings) {
  scan_files::ScanFile scan = scan_files::read_scan_file(file);
  scan_files::apply(scan_files::reading_of({scan}, {}), scan.cloud);
  fit::StageTimes times;
  return fit::measure_scan(geometry::points_of(scan.cloud), settings, times);
}

// A mesh or a scan, whichever of the two keys is there. The mesh keeps its vertices where references `number`
// them.
fit::Body body_in(const YAML::Node& node, const char* mesh, const char* scan, const std::string& path,
                  const fit::Settings& settings, bool number) {
  if (node[mesh].IsDefined() == node[scan].IsDefined())
    throw Refusal(kCode, fmt::format("{}: either '{}' or '{}' is needed", path, mesh, scan));
  const std::string file =
      beside(path, geometry::required<std::string>(node, node[scan] ? scan : mesh, path, kCode));
  if (node[scan]) return scanned_body(file, settings);
  mesh_files::Reading reading;
  fit::StageTimes times;
  return fit::measure_mesh(
      number ? geometry::read_ply_mesh(file) : scan_files::read_body_mesh(file, {}, false, reading), settings,
      times);
}

WornReference worn_in(const YAML::Node& node, const tensegric::Garment& garment, const fit::Body& bare,
                      const std::string& path, const fit::Settings& settings) {
  std::vector<control_mesh::Template> patterns;
  for (const std::string& region : garment.regions)
    patterns.push_back(control_mesh::load_template(
        geometry::yaml_file(geometry::shipped_folder("templates"), region, kCode)));
  fit::StageTimes times;
  const double cloth = node["cloth"] ? geometry::number_in(node, "cloth", correlation::kThickness.low,
                                                           correlation::kThickness.high, path, kCode)
                                     : 0;
  return {bare, prepare(bare, patterns, settings, times).control,
          body_in(node, "worn", "worn_scan", path, settings, false), cloth};
}

CalibrationCase read_case(const YAML::Node& node, const std::string& usual, const CalibrationBody& body,
                          const std::string& path, const fit::Settings& settings) {
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
      throw Refusal(kCode, path + ": " + name + ": a worn scan has neither 'file' nor 'tension'");
    WornReference reference = worn_in(node, worn, body.body, path, settings);
    return worn_case(name, std::move(worn), std::move(reference), body.body);
  }
  const auto newtons = geometry::optional<std::vector<double>>(node, "tension", {}, path, kCode);
  if (!newtons.empty() && newtons.size() != worn.lines.size())
    throw Refusal(kCode, path + ": " + name + ": 'tension' needs one number a line");
  for (const double pull : newtons)
    if (!(pull > 0 && std::isfinite(pull)))  // its logarithm is fitted
      throw Refusal(kCode, fmt::format("{}: {}: 'tension' is {:.4g}, not above 0", path, name, pull));
  return displaced_case(
      name, std::move(worn),
      read_reference(beside(path, geometry::required<std::string>(node, "file", path, kCode)),
                     body.body.mesh.mesh),
      newtons);
}

CalibrationBody read_body(const YAML::Node& node, const std::string& path, const fit::Settings& settings) {
  CalibrationBody body;
  body.name = geometry::required<std::string>(node, "name", path, kCode);
  body.body = body_in(node, "mesh", "scan", path, settings, true);
  const auto usual = geometry::optional<std::string>(node, "garment", "", path, kCode);
  std::map<std::string, int> times;  // of one garment and ratio there may be several: their names differ
  for (const YAML::Node& reference : node["references"]) {
    CalibrationCase one = read_case(reference, usual, body, path, settings);
    if (const int time = ++times[one.name]; time > 1) one.name += fmt::format(" ({})", time);
    body.cases.push_back(std::move(one));
  }
  if (body.cases.empty())
    throw Refusal(geometry::refusal::kTooFewData, path + ": body " + body.name + " has no references");
  return body;
}

// What can be refused before any body is measured.
void check(const YAML::Node& file, const std::string& path, bool worn) {
  geometry::check_keys(file, {"region", "fit", "bodies", "meshes"}, path, kCode);
  for (const char* key : {"fit", "meshes"})
    if (worn && file[key])
      throw Refusal(kCode, fmt::format("{}: '{}' is not for --worn, which fits pull and thickness at "
                                       "densities of its own",
                                       path, key));
  std::set<std::string> names;
  for (const YAML::Node& node : file["bodies"]) {
    geometry::check_keys(node, {"name", "mesh", "scan", "garment", "references"}, path, kCode);
    const auto name = geometry::required<std::string>(node, "name", path, kCode);
    if (!names.insert(name).second)  // bodies are left out by their names
      throw Refusal(kCode, path + ": body '" + name + "' is there twice");
  }
}

// Each body once a mesh.
std::vector<CalibrationBody> at_all(const YAML::Node& meshes, const std::vector<CalibrationBody>& bodies,
                                    const std::string& path) {
  std::vector<CalibrationBody> all;
  for (const YAML::Node& mesh : meshes) {
    geometry::check_keys(mesh, {"control_triangles", "layers"}, path, kCode);
    const Fineness fineness{
        static_cast<int>(geometry::number_in(mesh, "control_triangles", 1, 100000, path, kCode)),
        static_cast<int>(geometry::number_in(mesh, "layers", tensegric::kLayers.low, tensegric::kLayers.high,
                                             path, kCode))};
    for (const CalibrationBody& body : bodies) {
      all.push_back(body);
      all.back().fineness = fineness;
    }
  }
  return all;
}

}  // namespace

Cases read_cases(const std::string& path, const fit::Settings& settings, bool worn) {
  const YAML::Node file = geometry::load_yaml_map(path, kCode);
  check(file, path, worn);
  Cases cases;
  cases.options.fitted = geometry::optional(file, "fit", cases.options.fitted, path, kCode);
  std::set<std::string> regions;  // of the garments; the file may name one, too
  if (file["region"]) regions.insert(geometry::required<std::string>(file, "region", path, kCode));
  for (const YAML::Node& node : file["bodies"]) {
    cases.bodies.push_back(read_body(node, path, settings));
    for (const CalibrationCase& c : cases.bodies.back().cases)
      regions.insert(c.garment.regions.begin(), c.garment.regions.end());
  }
  if (file["meshes"]) cases.bodies = at_all(file["meshes"], cases.bodies, path);
  for (const std::string& region : regions)
    cases.patterns.push_back(control_mesh::load_template(
        geometry::yaml_file(geometry::shipped_folder("templates"), region, kCode)));
  return cases;
}

}  // namespace tensegric_fit::calibration
