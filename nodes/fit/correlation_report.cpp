#include "fit/correlation_report.hpp"

#include <fmt/format.h>

#include "geometry/enum_words.hpp"
#include "geometry/json.hpp"

namespace tensegric_fit::fit {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / 3.14159265358979323846;

Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const correlation::Summary& summary) {
  return {{"mean", summary.mean}, {"median", summary.median}, {"mean_size", summary.mean_size},
          {"rms", summary.rms},   {"p95", summary.p95},       {"compared", summary.compared}};
}

Json json_of(const std::vector<correlation::Difference>& differences) {
  Json json = Json::object();
  for (const correlation::Difference& d : differences) {
    Json entry{{"before", d.before}, {"simulated", json_of(d.simulated)}, {"worn", json_of(d.worn)}};
    entry["confidence"] = d.confidence;
    if (!d.reason.empty()) entry["reason"] = d.reason;
    json[d.name] = std::move(entry);
  }
  return json;
}

constexpr geometry::EnumWords<correlation::SkinPart, 4> kPartWords{
    {"covered", "surroundings", "still", "mobile"}};

Json in_degrees(const std::optional<double>& radians) {
  return radians ? Json(*radians * kDegrees) : Json(nullptr);
}

}  // namespace

Json report_of(const Correlated& correlated) {
  const correlation::Correlation& result = correlated.result;
  const correlation::Alignment& alignment = result.alignment;
  const correlation::Likeness& likeness = result.likeness;
  Json report;
  report["simulated"] = {{"scan", correlated.fitted.scan}};
  report["simulated"]["lines"] = Json::array();
  for (const FittedFolder::Line& line : correlated.fitted.lines)
    report["simulated"]["lines"].push_back(
        {{"name", line.name}, {"request", line.request}, {"ratio", line.ratio}});
  report["worn"] = {{"file", correlated.worn.file},
                    {"points", correlated.worn.points},
                    {"same_scan", correlated.same_scan}};
  report["status"] = "ok";
  report["reason"] = nullptr;
  report["thickness"] = correlated.thickness;
  report["alignment"] = {{"simulated_from_worn", geometry::json_of(alignment.patch_from_scan)},
                         {"status", to_string(alignment.status)},
                         {"steps", alignment.steps},
                         {"residual", alignment.residual}};
  report["likeness"] = {{"still", likeness.still},
                        {"stature", likeness.stature},
                        {"chest", json_of(likeness.chest)},
                        {"pelvis", json_of(likeness.pelvis)},
                        {"shanks", json_of(likeness.shanks)},
                        {"bend_degrees", in_degrees(likeness.bend)},
                        {"left_arm_degrees", in_degrees(likeness.left_arm)},
                        {"right_arm_degrees", in_degrees(likeness.right_arm)},
                        {"growth", likeness.growth}};
  report["distance"] = {{"covered", json_of(result.covered)}, {"still", json_of(result.still)}};
  report["effects"] = json_of(correlated.differences.effects);
  report["girths"] = json_of(correlated.differences.girths);
  report["heights"] = json_of(correlated.differences.heights);
  return report;
}

std::string distance_csv(const correlation::Correlation& result) {
  std::string text = "vertex,part,compared,distance_mm\n";
  for (std::size_t v = 0; v < result.parts.size(); ++v)
    text += fmt::format("{},{},{},{:.4f}\n", v, kPartWords.of(result.parts[v]), int(result.map.compared[v]),
                        1e3 * result.map.distance[v]);
  return text;
}

}  // namespace tensegric_fit::fit
