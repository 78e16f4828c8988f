#include "ros/export_fit.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "inspect/picture.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

[[noreturn]] void refuse(const char* code, const std::string& message) {
  throw geometry::Refusal(code, message);
}

ordered_json by_name(const std::vector<Measure>& measures) {
  ordered_json object = ordered_json::object();
  for (const Measure& measure : measures) object[measure.name] = measure.value;
  return object;
}

ordered_json landmarks_of(const Landmarks& landmarks) {
  ordered_json object = ordered_json::object();
  for (const Landmark& point : landmarks.points)
    object[point.name] = {{"position", point.position}, {"confidence", point.confidence}};
  return object;
}

ordered_json report_of(const FittedScan& scan) {
  ordered_json lines = ordered_json::array();
  for (const LineResult& line : scan.fit->lines)
    lines.push_back({{"name", line.name},
                     {"initial", line.initial},
                     {"neutral", line.neutral},
                     {"final", line.final},
                     {"request", line.request},
                     {"ratio", line.ratio},
                     {"tension", line.tension}});
  ordered_json regions = ordered_json::array();
  for (const RegionResult& region : scan.fit->regions)
    regions.push_back(
        {{"name", region.name}, {"control_volume", {region.volume_before, region.volume_after}}});

  ordered_json report;
  report["scan"] = {{"scan_id", scan.body->scan_id}, {"frame", scan.body->header.frame_id}};
  report["garment"] = scan.fit->garment;
  report["landmarks"] = landmarks_of(*scan.landmarks);
  report["heights"] = by_name(scan.landmarks->heights);
  report["girths"] = by_name(scan.landmarks->girths);
  report["solver"] = {{"name", scan.fit->solver},
                      {"status", scan.fit->status},
                      {"iterations", scan.fit->iteration},
                      {"residual", scan.fit->residual},
                      {"ms", scan.fit->milliseconds}};
  report["lines"] = lines;
  report["regions"] = regions;
  report["body"] = {{"vertices", scan.body->vertices.size() / 3},
                    {"triangles", scan.body->triangles.size() / 3},
                    {"volume", {scan.deformed->volume_before, scan.deformed->volume_after}}};
  return report;
}

void write_files(const FittedScan& scan, const fs::path& folder) {
  const geometry::TriangleMesh body = mesh_in(*scan.body);
  const geometry::ControlMesh control = control_in(*scan.control);
  const std::vector<double> distortion(scan.deformed->distortion.begin(), scan.deformed->distortion.end());
  geometry::write_ply_mesh(folder / "body.ply", body);
  geometry::write_ply_mesh(folder / "control.ply", {control.outer, control.triangles}, {},
                           geometry::Coordinates::float64);
  geometry::write_ply_mesh(folder / "control_deformed.ply", {points_in(scan.fit->outer), control.triangles},
                           {}, geometry::Coordinates::float64);
  geometry::write_ply_mesh(folder / "deformed.ply", {points_in(scan.deformed->vertices), body.triangles},
                           inspect::distortion_colours(distortion));
  std::ofstream report(folder / "report.json");
  // names may come from any publisher: what is no UTF-8 is replaced, not thrown at
  report << report_of(scan).dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
  report.close();
  if (!report) throw std::runtime_error("cannot write " + (folder / "report.json").string());
}

}  // namespace

std::vector<std::string> export_fit(const FittedScan& scan, const std::string& directory) {
  fs::path wanted = fs::path(directory).lexically_normal();
  if (!wanted.has_filename()) wanted = wanted.parent_path();  // a slash at the end
  if (!wanted.is_absolute() || !wanted.has_filename())
    refuse(geometry::refusal::kBadOption, fmt::format("directory '{}' is not an absolute path", directory));
  std::error_code ignored;  // a path that cannot be looked at cannot be written either, which says why
  if (fs::exists(wanted, ignored) && !fs::is_empty(wanted, ignored))
    refuse(geometry::refusal::kBadOption,
           fmt::format("'{}' is there already and is not overwritten", wanted.string()));

  const fs::path folder = wanted.parent_path() / fmt::format(".{}.{}", wanted.filename().string(), getpid());
  try {
    fs::create_directories(folder);
    write_files(scan, folder);
    fs::rename(folder, wanted);  // fails where a filled directory has come up meanwhile
  } catch (const std::runtime_error& error) {
    fs::remove_all(folder, ignored);
    refuse(geometry::refusal::kBrokenFile,
           fmt::format("cannot export to '{}': {}", wanted.string(), error.what()));
  }
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(wanted))
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace tensegric_fit::node
