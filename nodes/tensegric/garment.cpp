#include "tensegric/garment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/checked_yaml.hpp"
#include "geometry/shipped_files.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
using geometry::refusal::kBadGarment;

std::vector<std::string> words(const YAML::Node& map, const char* key, const std::string& where) {
  if (!map[key]) return {};
  if (map[key].IsScalar()) return {map[key].Scalar()};
  return geometry::required<std::vector<std::string>>(map, key, where, kBadGarment);
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Refusal(kBadGarment, where + ": " + what);
}

void check(const char* key, double value, const geometry::Range& range, const std::string& where) {
  if (!range.holds(value))
    refuse(where, fmt::format("'{}' is {:g}, outside [{:g}, {:g}]", key, value, range.low, range.high));
}

/// \param where the line
void check_ratio(double ratio, const std::string& where) {
  const bool is_percent = ratio > kRatio.high && kRatio.holds(ratio / 100);
  if (is_percent) refuse(where, fmt::format("'ratio' is {:g}; {:g} % is {:g}", ratio, ratio, ratio / 100));
  check("ratio", ratio, kRatio, where);
}

void check_table(std::vector<std::pair<double, double>>& table, const std::string& where) {
  if (table.empty()) refuse(where, "'table' has no rows");
  if (table.front().first > 1) table.insert(table.begin(), {1, 0});
  if (table.front() != std::pair<double, double>(1, 0))
    refuse(where, "'table' must begin at stretch 1 or above, and have no tension there");
  if (table.size() < 2) refuse(where, "'table' needs a row beyond stretch 1");
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto& [stretch, tension] = table[i];
    if (!std::isfinite(stretch) || !kTension.holds(tension))
      refuse(where, "'table' needs finite stretches and tensions");
    if (stretch <= table[i - 1].first || tension < table[i - 1].second)
      refuse(where, "the rows of 'table' must ascend");
  }
  if (table.back().second == 0) refuse(where, "'table' has no tension: such a line pulls nothing");
}

std::vector<std::pair<double, double>> read_table(const YAML::Node& law, const std::string& where) {
  const auto rows = geometry::required<std::vector<std::vector<double>>>(law, "table", where, kBadGarment);
  std::vector<std::pair<double, double>> table;
  for (const std::vector<double>& row : rows) {
    if (row.size() != 2) refuse(where, "each row of 'table' must be [stretch, tension]");
    table.emplace_back(row[0], row[1]);
  }
  return table;
}

TensionLaw read_law(const YAML::Node& line, const std::string& where) {
  TensionLaw law;
  const YAML::Node node = line["law"];
  if (!node || (node.IsScalar() && node.Scalar() == "rigid")) return law;
  if (!node.IsMap() || node.size() != 1)
    refuse(where, "'law' must be rigid, {stiffness: s} or {table: [[stretch, tension], ...]}");
  geometry::check_keys(node, {"stiffness", "table"}, where + ": law", kBadGarment);
  if (node["stiffness"]) {
    law.kind = TensionLaw::Kind::stiffness;
    law.stiffness = geometry::required<double>(node, "stiffness", where, kBadGarment);
  } else {
    law.kind = TensionLaw::Kind::table;
    law.table = read_table(node, where);
  }
  return law;
}

std::vector<Eigen::Vector3d> read_points(const YAML::Node& line, const std::string& where) {
  const auto rows = geometry::required<std::vector<std::vector<double>>>(line, "points", where, kBadGarment);
  if (rows.empty()) refuse(where, "'points' is empty");
  std::vector<Eigen::Vector3d> points;
  for (const std::vector<double>& row : rows) {
    if (row.size() != 3) refuse(where, "each of 'points' must be [x, y, z] in metres");
    points.emplace_back(row[0], row[1], row[2]);
  }
  return points;
}

GarmentLine read_line(const YAML::Node& node, const std::string& where) {
  if (!node.IsMap()) refuse(where, "must be a map");
  geometry::check_keys(node,
                       {"name", "ratio", "law", "tension_limit", "through", "fan", "follow", "points",
                        "width", "smooth", "ends"},
                       where, kBadGarment);
  const auto number = [&](const char* key, double fallback) {
    return geometry::optional(node, key, fallback, where, kBadGarment);
  };
  GarmentLine line;
  line.name = geometry::required<std::string>(node, "name", where, kBadGarment);
  line.ratio = number("ratio", line.ratio);
  line.law = read_law(node, where);
  if (node["tension_limit"])  // none is said by leaving it out, not by .inf
    line.tension_limit =
        geometry::number_in(node, "tension_limit", kTension.low, kTension.high, where, kBadGarment);
  line.through = words(node, "through", where);
  if (node["through"] && line.through.empty()) refuse(where, "'through' is empty");
  line.fan = words(node, "fan", where);
  if (node["fan"] && line.fan.empty()) refuse(where, "'fan' is empty");
  const auto follow = geometry::optional<std::string>(node, "follow", "skin", where, kBadGarment);
  if (follow != "skin" && follow != "taut") refuse(where, "'follow' is '" + follow + "', not skin or taut");
  line.taut = follow == "taut";
  if (node["points"]) line.points = read_points(node, where);
  line.width = number("width", line.through.empty() ? 0 : kBandWidth);
  line.smooth = number("smooth", !line.through.empty() && line.width > 0 ? kBandSmooth : 0);
  if (node["ends"]) {
    if (line.points.empty())
      refuse(where,
             "'ends' is for lines that are given by 'points'; a line by 'through' ends as its last node "
             "does");
    line.held =
        held_in(geometry::required<std::vector<std::string>>(node, "ends", where, kBadGarment), where);
  }
  check_line(line, where);
  return line;
}

bool has_line(const Garment& garment, const std::string& name) {
  return std::any_of(garment.lines.begin(), garment.lines.end(),
                     [&name](const GarmentLine& line) { return line.name == name; });
}

}  // namespace

std::array<bool, 2> held_in(const std::vector<std::string>& words, const std::string& where) {
  if (words.size() != 2) refuse(where, "'ends' must be two words, one per end");
  for (const std::string& word : words)
    if (word != kHeldByBone && word != kCarriedBySkin)
      refuse(where, "an end is '" + word + "', neither " + kHeldByBone + " nor " + kCarriedBySkin);
  return {words[0] == kHeldByBone, words[1] == kHeldByBone};
}

void check_line(GarmentLine& line, const std::string& where) {
  if (line.name.empty()) refuse(where, "'name' is empty");
  check_ratio(line.ratio, where);
  check("stiffness", line.law.stiffness, kTension, where);
  if (line.law.kind == TensionLaw::Kind::table) check_table(line.law.table, where);
  // In messages 0 stands for no limit, and for no stiffness.
  if (line.law.kind == TensionLaw::Kind::stiffness && line.law.stiffness == 0)
    refuse(where, "'stiffness' is 0: such a line pulls nothing");
  if (line.tension_limit == 0) refuse(where, "'tension_limit' is 0: such a line pulls nothing");
  if (line.tension_limit != std::numeric_limits<double>::infinity())
    check("tension_limit", line.tension_limit, kTension, where);
  if (line.through.size() == 1 && line.fan.empty()) refuse(where, "'through' needs two nodes or more");
  if (line.fan.size() == 1) refuse(where, "'fan' needs two nodes or more");
  if (!line.fan.empty() && line.through.empty())
    refuse(where, "'fan' is for lines that are given by 'through'");
  if (line.points.size() == 1) refuse(where, "'points' needs two points or more");
  if (!line.through.empty() && !line.points.empty()) refuse(where, "has both 'through' and 'points'");
  for (const Eigen::Vector3d& point : line.points)
    if (!point.allFinite()) refuse(where, "'points' are not all finite");
  check("width", line.width, kLineWidth, where);
  if (line.taut && line.through.empty() && !line.on_body())
    refuse(where,
           "'follow' says 'taut', which a string of the template's own course cannot be: give its nodes by "
           "'through'");
  check("smooth", line.smooth, kLineWidth, where);
  if (!line.fan.empty() && line.width == 0) refuse(where, "'fan' needs a 'width' above 0, where it begins");
  if (line.smooth > 0 && !line.on_body())
    refuse(where, "'smooth' is for bands and for lines that are given by 'points'");
}

Garment load_garment(const std::string& path) {
  const YAML::Node root = geometry::load_yaml_map(path, kBadGarment);
  geometry::check_keys(root, {"name", "title", "about", "region", "lines"}, path, kBadGarment);
  for (const char* key : {"title", "about"}) geometry::optional(root, key, std::string(), path, kBadGarment);
  Garment garment;
  garment.name = geometry::required<std::string>(root, "name", path, kBadGarment);
  garment.regions = words(root, "region", path);
  if (garment.regions.empty()) throw Refusal(kBadGarment, path + ": key 'region' is missing or empty");
  if (!root["lines"] || !root["lines"].IsSequence() || root["lines"].size() == 0)
    throw Refusal(kBadGarment, path + ": 'lines' must list one line or more");
  for (std::size_t i = 0; i < root["lines"].size(); ++i) {
    const GarmentLine line = read_line(root["lines"][i], path + ": line " + std::to_string(i + 1));
    if (has_line(garment, line.name))
      throw Refusal(kBadGarment, path + ": two lines are named '" + line.name + "'");
    garment.lines.push_back(line);
  }
  return garment;
}

Garment take_garment(const std::string& words, const std::string& folder) {
  const std::vector<std::string> parts = geometry::joined_words(words);
  if (parts.size() == 1) return load_garment(geometry::yaml_file(folder, words, kBadGarment));
  Garment all;
  for (const std::string& part : parts) {
    const Garment one = load_garment(geometry::yaml_file(folder, part, kBadGarment));
    all.name += (&part == &parts.front() ? "" : "+") + one.name;
    for (const std::string& region : one.regions)
      if (std::find(all.regions.begin(), all.regions.end(), region) == all.regions.end())
        all.regions.push_back(region);
    for (const GarmentLine& line : one.lines) {
      if (has_line(all, line.name))
        throw Refusal(kBadGarment, "of " + words + " two garments have a line '" + line.name + "'");
      all.lines.push_back(line);
    }
  }
  return all;
}

void set_ratio(Garment& garment, const std::string& line, double ratio) {
  check_ratio(ratio, "garment " + garment.name + (line.empty() ? "" : ", line '" + line + "'"));
  bool found = line.empty();
  for (GarmentLine& l : garment.lines) {
    if (!line.empty() && l.name != line) continue;
    l.ratio = ratio;
    found = true;
  }
  if (!found)
    throw Refusal(geometry::refusal::kUnknownLine, "garment " + garment.name + " has no line '" + line + "'");
}

}  // namespace tensegric_fit::tensegric
