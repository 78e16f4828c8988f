#include "fit/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "files/csv.hpp"
#include "fit/effects.hpp"
#include "geometry/json.hpp"
#include "inspect/colour_scale.hpp"
#include "inspect/warning_words.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::fit {
namespace {

using Json = nlohmann::ordered_json;
using geometry::json_of;

Json axes_of(const mesh_files::Reading& reading) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back(json_of(Eigen::Vector3d(reading.turn().row(r).transpose())));
  return {{"up", reading.up}, {"scan_from_file", std::move(rows)}};
}

Json stages_of(const StageTimes& times) {
  const auto ms = [](double value) { return Json{{"ms", value}}; };
  return {{"reconstruction", ms(times.reconstruction)}, {"body_model", ms(times.body_model)},
          {"landmarks", ms(times.landmarks)},           {"control_mesh", ms(times.control_mesh)},
          {"tensegric", ms(times.tensegric)},           {"tffd", ms(times.tffd)}};
}

Json model_of(const body_model::RegisteredBody& body) {
  constexpr double kDegrees = 180 / M_PI;
  const auto& [groups, turns] = std::tie(body.model->groups, body.parameters.turns);
  Json pose = Json::object();
  for (std::size_t g = 0; g < groups.size(); ++g) pose[groups[g].name] = json_of(kDegrees * turns[g]);
  const double up = std::atan2(body.vertical.head<2>().norm(), body.vertical.z());
  return {{"residual", body.residual},
          {"misfit", body.evidence.misfit},
          {"unexplained", body.evidence.unexplained},
          {"shape_deviation", body.evidence.shape},
          {"note", body.note},
          {"stature", body.stature()},
          {"shape", std::vector<double>(body.parameters.shape.begin(), body.parameters.shape.end())},
          {"pose", std::move(pose)},
          {"up_deviation_deg", kDegrees * up},
          {"parts", body.model->parts},
          {"model", body.model->checksum}};
}

void add_measures(const geometry::BodyMeasures& measures, Json& report) {
  report["landmarks"] = report["heights"] = report["girths"] = report["confidence"] = Json::object();
  for (const auto& l : measures.landmarks) {
    Json entry{{"position", json_of(l.position)}, {"confidence", l.confidence}};
    if (l.half_width > 0) entry["half_width"] = l.half_width;
    if (!l.reason.empty()) entry["reason"] = l.reason;
    report["landmarks"][l.name] = std::move(entry);
  }
  const auto add = [&report](const char* kind, const std::vector<geometry::Measure>& list) {
    for (const auto& m : list) {
      report[kind][m.name] = m.metres;
      Json entry{{"confidence", m.confidence}};
      if (m.half_width > 0) entry["half_width"] = m.half_width;
      if (!m.reason.empty()) entry["reason"] = m.reason;
      report["confidence"][kind][m.name] = std::move(entry);
    }
  };
  add("heights", measures.heights);
  add("girths", measures.girths);
  report["missing"] = Json::object();
  for (const geometry::Missing& missing : measures.missing) report["missing"][missing.name] = missing.reason;
}

Json json_of(const geometry::FitWarning& warning, const geometry::BodyMeasures& measures) {
  using namespace geometry;
  Json entry{{"code", warning.code},
             {"message", inspect::words::warning(warning, measures)},
             {"place", json_of(warning.at_rest)},
             {"place_worn", json_of(warning.worn)}};
  const Landmark* landmark = inspect::words::nearest_landmark(measures, warning.at_rest);
  entry["landmark"] = landmark == nullptr ? Json() : Json(landmark->name);
  entry["line"] = warning.line.empty() ? Json() : Json(warning.line);
  entry["area_cm2"] = 1e4 * warning.area;
  if (warning.code == notice::kOverStretched || warning.code == notice::kPressedTogether) {
    entry["stretch"] = warning.value;
  } else if (warning.code == warning::kSkinCrosses || warning.code == notice::kSkinOverLine) {
    entry["depth_mm"] = 1e3 * warning.value;
  } else if (warning.code == notice::kNotScanned) {
    entry["share"] = warning.value;
  } else if (warning.code == notice::kUnderConstricted) {
    entry["lack"] = warning.lack;
    entry[warning.lack == lack::kLiftsOff ? "share" : "tension"] = warning.value;
  } else {
    entry["shelf_cm2"] = 1e4 * warning.shelf_area;
    entry["largest_turn_deg"] = warning.value * 180 / M_PI;
  }
  return entry;
}

void add_fit(const Body& body, const Fitting& fitting, const Fit& fit,
             const std::vector<geometry::FitWarning>& warnings, const Settings& settings,
             const StageTimes& times, Json& report) {
  const tensegric::Solution& solution = fit.solution;
  report["control"] = {{"nodes", fitting.control.outer.size()},
                       {"triangles", fitting.control.triangles.size()},
                       {"struts", fitting.model.struts()},
                       {"tensile_parts", fitting.model.tensile_parts()},
                       {"free_nodes", fitting.model.free_nodes()}};
  const geometry::Posture& posture = settings.solver.bones.posture();
  report["posture"] = {{"twist", posture.twist * 180 / M_PI}, {"lean", posture.side_lean * 180 / M_PI}};
  report["solver"] = {{"name", to_string(settings.solver.solver)},
                      {"status", to_string(solution.status)},
                      {"iterations", solution.iterations},
                      {"residual", solution.residual},
                      {"ms", times.tensegric},
                      {"note", solution.note}};
  report["lines"] = Json::array();
  for (const auto& line : solution.lines) {
    report["lines"].push_back({{"name", line.name},
                               {"initial", line.initial},
                               {"neutral", line.neutral},
                               {"final", line.final},
                               {"request", line.request},
                               {"ratio", line.final / line.initial},
                               {"straight", line.straight},
                               {"reachable", line.reachable},
                               {"tension", line.tension}});
    if (!solution.calibrated) continue;
    report["lines"].back()["tension_N"] = line.newtons;
    if (line.pressure > 0) report["lines"].back()["pressure_kPa"] = 1e-3 * line.pressure;
  }
  report["regions"] = Json::array();
  for (std::size_t r = 0; r < solution.regions.size(); ++r) {
    const auto& region = solution.regions[r];
    report["regions"].push_back({{"name", region.name},
                                 {"control_volume", {region.volume_before, region.volume_after}},
                                 {"body_volume", {fit.body_volumes_before[r], fit.body_volumes_after[r]}}});
  }
  report["effects"] = Json::object();
  for (const Effect& effect : effects_of(body, fit))
    report["effects"][effect.name] = {
        {"before", effect.before}, {"after", effect.after}, {"mm", 1e3 * (effect.after - effect.before)}};
  const auto [low, high] = std::minmax_element(fit.distortion.begin(), fit.distortion.end());
  Json tight = Json::array(), stretched = Json::array();
  for (std::size_t v = 0; v < fit.distortion.size(); ++v) {
    if (fit.distortion[v] < inspect::kOverConstricted) tight.push_back(v);
    if (fit.distortion[v] > inspect::kOverStretched) stretched.push_back(v);
  }
  report["distortion"] = {{"min", *low},
                          {"max", *high},
                          {"over_constricted", std::move(tight)},
                          {"over_stretched", std::move(stretched)},
                          {"under_constricted", tffd::under_constricted_skin(warnings)}};
  report["warnings"] = report["notices"] = Json::array();
  for (const geometry::FitWarning& warning : warnings)
    report[warning.is_warning() ? "warnings" : "notices"].push_back(json_of(warning, body.measures));
}

}  // namespace

Json report_of(const Source& source, const Body& body, const Fitting* fitting, const Fit* fit,
               const std::vector<geometry::FitWarning>& warnings, const Settings& settings,
               const StageTimes& times) {
  Json report;
  report["scan"] = {{"file", source.file},
                    {"more_files", source.more},
                    {"points", source.points},
                    {"points_used", body.mesh.points_used},
                    {"unit", source.reading.unit},
                    {"axes", axes_of(source.reading)},
                    {"body_from_scan", json_of(body.measures.body_from_scan)}};
  if (!source.garment.empty()) report["garment"] = source.garment;
  if (!source.customer.empty()) report["scan"]["customer"] = source.customer;
  report["status"] = "ok";
  report["reason"] = nullptr;
  report["stages"] = stages_of(times);
  report["body"] = {{"vertices", body.mesh.mesh.vertices.size()},
                    {"triangles", body.mesh.mesh.triangles.size()},
                    {"closed", geometry::is_closed(body.mesh.mesh)}};
  report["body"]["holes"] = Json::array();
  for (const auto& hole : body.mesh.holes)
    report["body"]["holes"].push_back(
        {{"centre", json_of(hole.centre)}, {"area", hole.area}, {"confidence", hole.confidence}});
  report["body"]["fractures"] = Json::array();
  for (const geometry::Fracture& fracture : body.mesh.fractures)
    report["body"]["fractures"].push_back({{"centre", json_of(fracture.centre)},
                                           {"radius", fracture.radius},
                                           {"area", fracture.area},
                                           {"offset", fracture.offset}});
  if (body.model) report["body_model"] = model_of(*body.model);
  report["unexplained"] = Json::array();
  if (body.model)
    for (const body_model::Unexplained& thing : body.model->unexplained)
      report["unexplained"].push_back({{"centre", json_of(thing.centre)},
                                       {"extent", thing.extent},
                                       {"share", thing.share},
                                       {"reason", thing.reason}});
  add_measures(body.measures, report);
  if (fit != nullptr) add_fit(body, *fitting, *fit, warnings, settings, times, report);
  return report;
}

Json report_of(const Source& source, const geometry::Refusal& refusal) {
  Json report;
  report["scan"] = {{"file", source.file}, {"more_files", source.more}, {"points", source.points}};
  if (!source.customer.empty()) report["scan"]["customer"] = source.customer;
  report["status"] = "refused";
  report["reason"] = {{"code", refusal.code()}, {"message", refusal.what()}};
  return report;
}

std::string history_csv(const Body& body, const Fitting& fitting, const tensegric::Solution& solution) {
  std::string text = "iteration";
  for (const auto& line : solution.lines) text += "," + files::csv_field("ratio_" + line.name);
  for (const auto& region : solution.regions) text += "," + files::csv_field("volume_error_" + region.name);
  for (int node : tracked_nodes(fitting.control)) text += ",height_" + fitting.control.names[node];
  text += ",residual\n";
  for (const auto& row : solution.history) {
    text += std::to_string(row.iteration);
    for (double ratio : row.line_ratios) text += fmt::format(",{:.12g}", ratio);
    for (double error : row.volume_errors) text += fmt::format(",{:.6g}", error);
    for (const auto& point : row.tracked)
      text += fmt::format(",{:.9g}", (body.measures.body_from_scan * point).z());
    text += fmt::format(",{:.6g}\n", row.residual);
  }
  return text;
}

std::vector<int> tracked_nodes(const geometry::ControlMesh& control) {
  std::vector<int> nodes;
  for (const char* name : {"bust_point_L", "bust_point_R"})
    if (control.node(name) >= 0) nodes.push_back(control.node(name));
  return nodes;
}

}  // namespace tensegric_fit::fit
