#include "ros/fit_document.hpp"

#include <fmt/format.h>
#include <tensegric_fit/GarmentLine.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "files/csv.hpp"
#include "geometry/json.hpp"
#include "geometry/json_text.hpp"
#include "inspect/warning_words.hpp"
#include "ros/line_force.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::ChangedMeasure;
using nlohmann::ordered_json;

constexpr char kFormat[] = "tensegric_fit/fit", kSealedFormat[] = "tensegric_fit/sealed";
constexpr int kVersion = 1;  // of the schema; counts up when a field changes its meaning or goes

/// To the micrometre.
double millimetres(double metres) {
  return std::round(1e6 * metres) / 1e3;
}

ordered_json millimetres(const Eigen::Vector3d& point) {
  return {millimetres(point.x()), millimetres(point.y()), millimetres(point.z())};
}

double cubic_centimetres(double cubic_metres) {
  return std::round(1e9 * cubic_metres) / 1e3;
}

/// As garment files say it.
ordered_json law_of(const LineResult& line) {
  if (line.law == GarmentLine::STIFFNESS) return {{"stiffness", line.stiffness}};
  if (line.law != GarmentLine::TABLE) return GarmentLine::RIGID;
  ordered_json table = ordered_json::array();
  for (std::size_t i = 0; i < line.table_stretch.size(); ++i)
    table.push_back(ordered_json::array({line.table_stretch[i], line.table_tension[i]}));
  return {{"table", std::move(table)}};
}

ordered_json garment_of(const FittedScan& scan) {
  const FitState& fit = *scan.fit;
  ordered_json lines = ordered_json::array();
  for (std::size_t i = 0; i < fit.lines.size(); ++i) {
    const LineResult& line = fit.lines[i];
    lines.push_back(
        {{"name", line.name},
         {"rest_mm", millimetres(line.initial)},
         {"neutral_mm", millimetres(line.neutral)},
         {"worn_mm", millimetres(line.final)},
         {"request", line.request},
         {"ratio", line.ratio},
         {"tension", line.tension},
         {"law", law_of(line)},
         {"tension_limit", line.tension_limit > 0 ? ordered_json(line.tension_limit) : ordered_json()}});
    if (const auto force = scan.forces ? force_of(*scan.forces, fit, i) : std::nullopt) {
      lines.back()["tension_N"] = force->newtons;
      if (force->kilopascals > 0) lines.back()["pressure_kPa"] = force->kilopascals;
    }
  }
  return {{"name", fit.garment}, {"lines", std::move(lines)}};
}

ordered_json measure_of(const ChangedMeasure& measure) {
  ordered_json object = {{"name", measure.before.name}, {"before_mm", millimetres(measure.before.metres)}};
  object["after_mm"] = measure.after ? ordered_json(millimetres(*measure.after)) : ordered_json();
  object["confidence"] = measure.before.confidence;
  if (measure.before.half_width > 0) object["half_width_mm"] = millimetres(measure.before.half_width);
  if (!measure.before.reason.empty()) object["reason"] = measure.before.reason;
  return object;
}

ordered_json measures_of(const std::vector<ChangedMeasure>& measures) {
  ordered_json list = ordered_json::array();
  for (const ChangedMeasure& measure : measures) list.push_back(measure_of(measure));
  return list;
}

ordered_json size_of(const FitFigures& figures, std::size_t which) {
  return which < figures.sizes.size() ? ordered_json(figures.sizes[which].label()) : ordered_json();
}

ordered_json body_of(const FitFigures& figures) {
  ordered_json landmarks = ordered_json::array(), missing = ordered_json::array();
  const auto after = geometry::landmarks_after(figures.measures, {figures.body, figures.deformed});
  for (std::size_t i = 0; i < after.size(); ++i) {
    const geometry::Landmark& landmark = figures.measures.landmarks[i];
    landmarks.push_back({{"name", landmark.name},
                         {"before_mm", millimetres(landmark.position)},
                         {"after_mm", millimetres(after[i])},
                         {"confidence", landmark.confidence}});
  }
  for (const geometry::Missing& part : figures.measures.missing)
    missing.push_back({{"name", part.name}, {"reason", part.reason}});
  return {{"bra_size",
           {{"standard", "EN 13402-3"},
            {"before", size_of(figures, 0)},
            {"alternative", size_of(figures, 1)},
            {"after", figures.size_after ? ordered_json(figures.size_after->label()) : ordered_json()}}},
          {"heights", measures_of(figures.heights)},
          {"girths", measures_of(figures.girths)},
          {"landmarks", std::move(landmarks)},
          {"missing", std::move(missing)}};
}

ordered_json volumes_of(const FittedScan& scan) {
  const auto volume = [](const std::string& name, double before, double after) -> ordered_json {
    return {
        {"name", name}, {"before_cm3", cubic_centimetres(before)}, {"after_cm3", cubic_centimetres(after)}};
  };
  ordered_json volumes = ordered_json::array();
  volumes.push_back(volume("body", scan.deformed->volume_before, scan.deformed->volume_after));
  for (const RegionResult& region : scan.fit->regions)
    volumes.push_back(volume(region.name, region.volume_before, region.volume_after));
  return volumes;
}

ordered_json warnings_of(const FitFigures& figures, bool warnings) {
  ordered_json list = ordered_json::array();
  for (const geometry::FitWarning& warning : figures.scan.warnings) {
    if (warning.is_warning() != warnings) continue;
    list.push_back({{"code", warning.code},
                    {"message", inspect::words::warning(warning, figures.measures)},
                    {"line", warning.line},
                    {"place_mm", millimetres(warning.at_rest)},
                    {"area_cm2", 1e4 * warning.area}});
  }
  return list;
}

}  // namespace

std::string fit_json(const FitFigures& figures, const std::vector<std::string>& files) {
  const FitState& fit = *figures.scan.fit;
  const auto [tightest, loosest] = std::minmax_element(figures.distortion.begin(), figures.distortion.end());
  ordered_json document;
  document["format"] = kFormat;
  document["version"] = kVersion;
  document["software"] = {{"name", "tensegric_fit"}, {"version", TENSEGRIC_FIT_VERSION}};
  document["scan"] = {{"scan_id", figures.scan.body->scan_id},
                      {"frame", figures.scan.body->header.frame_id},
                      {"body_from_scan", geometry::json_of(figures.measures.body_from_scan)}};
  if (!figures.scan.label.source.empty()) document["scan"]["source"] = figures.scan.label.source;
  if (!figures.scan.label.customer.empty()) document["scan"]["customer"] = figures.scan.label.customer;
  document["garment"] = garment_of(figures.scan);
  document["solver"] = {{"name", fit.solver},
                        {"status", fit.status},
                        {"note", fit.note},
                        {"iterations", fit.iteration},
                        {"residual", fit.residual}};
  document["posture"] = {{"twist_rad", fit.twist}, {"side_lean_rad", fit.side_lean}};
  document["body"] = body_of(figures);
  document["body"]["head"] = figures.head;
  document["volumes"] = volumes_of(figures.scan);
  document["distortion"] = {{"min", *tightest}, {"max", *loosest}};
  document["warnings"] = warnings_of(figures, true);
  document["notices"] = warnings_of(figures, false);
  document["files"] = files;
  // names may come from any publisher: what is no UTF-8 is replaced, not thrown at
  return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::optional<std::string> scan_id_in(const std::string& text) {
  const nlohmann::json document = geometry::json_in(text);
  if (!document.is_object() || !document.contains("format")) return std::nullopt;
  if (document["format"] != kFormat && document["format"] != kSealedFormat) return std::nullopt;
  const nlohmann::json scan = document.value("scan", nlohmann::json());
  const nlohmann::json id = scan.is_object() ? scan.value("scan_id", nlohmann::json()) : nlohmann::json();
  return id.is_string() ? std::optional<std::string>(id) : std::nullopt;
}

std::string sealed_json(const std::string& scan_id) {
  const ordered_json document = {
      {"format", kSealedFormat}, {"version", kVersion}, {"scan", {{"scan_id", scan_id}}}};
  return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string measurements_csv(const FitFigures& figures) {
  std::string text = "kind,name,before_mm,after_mm,confidence,half_width_mm,reason\r\n";
  for (const auto& [kind, measures] : {std::pair{"height", &figures.heights}, {"girth", &figures.girths}}) {
    for (const ChangedMeasure& measure : *measures) {
      const geometry::Measure& before = measure.before;
      text += fmt::format("{},{},{:.1f},{},{:.2f},{},{}\r\n", kind, files::csv_field(before.name),
                          1e3 * before.metres,
                          measure.after ? fmt::format("{:.1f}", 1e3 * *measure.after) : "", before.confidence,
                          before.half_width > 0 ? fmt::format("{:.1f}", 1e3 * before.half_width) : "",
                          files::csv_field(before.reason));
    }
  }
  return text;
}

}  // namespace tensegric_fit::node
