#include "tensegric/garment.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

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

std::vector<std::pair<double, double>> read_table(const YAML::Node& law, const std::string& where) {
  const auto rows = geometry::required<std::vector<std::vector<double>>>(law, "table", where, kBadGarment);
  std::vector<std::pair<double, double>> table;
  for (const std::vector<double>& row : rows) {
    if (row.size() != 2)
      throw Refusal(kBadGarment, where + ": each row of 'table' must be [stretch, tension]");
    if (!std::isfinite(row[0]) || row[0] < 1 || !(row[1] >= 0 && row[1] <= kHighestTension))
      throw Refusal(kBadGarment,
                    where + ": 'table' needs stretches of at least 1 and tensions of at least 0");
    if (!table.empty() && (row[0] <= table.back().first || row[1] < table.back().second))
      throw Refusal(kBadGarment, where + ": the rows of 'table' must ascend");
    table.emplace_back(row[0], row[1]);
  }
  if (table.empty()) throw Refusal(kBadGarment, where + ": 'table' has no rows");
  if (table.front().first == 1 && table.front().second != 0)
    throw Refusal(kBadGarment, where + ": 'table' must have no tension at stretch 1");
  if (table.front().first > 1) table.insert(table.begin(), {1, 0});
  if (table.size() < 2) throw Refusal(kBadGarment, where + ": 'table' needs a row beyond stretch 1");
  return table;
}

TensionLaw read_law(const YAML::Node& line, const std::string& where) {
  TensionLaw law;
  const YAML::Node node = line["law"];
  if (!node || (node.IsScalar() && node.Scalar() == "rigid")) return law;
  if (!node.IsMap() || node.size() != 1)
    throw Refusal(kBadGarment,
                  where + ": 'law' must be rigid, {stiffness: s} or {table: [[stretch, tension], ...]}");
  geometry::check_keys(node, {"stiffness", "table"}, where + ": law", kBadGarment);
  if (node["stiffness"]) {
    law.kind = TensionLaw::Kind::stiffness;
    law.stiffness = geometry::number_in(node, "stiffness", 0, kHighestTension, where, kBadGarment);
  } else {
    law.kind = TensionLaw::Kind::table;
    law.table = read_table(node, where);
  }
  return law;
}

std::vector<Eigen::Vector3d> read_points(const YAML::Node& line, const std::string& where) {
  const auto rows = geometry::required<std::vector<std::vector<double>>>(line, "points", where, kBadGarment);
  std::vector<Eigen::Vector3d> points;
  for (const std::vector<double>& row : rows) {
    if (row.size() != 3 || !Eigen::Vector3d(row[0], row[1], row[2]).allFinite())
      throw Refusal(kBadGarment, where + ": each of 'points' must be [x, y, z] in metres");
    points.emplace_back(row[0], row[1], row[2]);
  }
  if (points.size() < 2) throw Refusal(kBadGarment, where + ": 'points' needs two points or more");
  return points;
}

GarmentLine read_line(const YAML::Node& node, const std::string& where) {
  if (!node.IsMap()) throw Refusal(kBadGarment, where + ": must be a map");
  geometry::check_keys(
      node,
      {"name", "ratio", "law", "tension_limit", "through", "follow", "points", "width", "smooth", "ends"},
      where, kBadGarment);
  GarmentLine line;
  line.name = geometry::required<std::string>(node, "name", where, kBadGarment);
  if (line.name.empty()) throw Refusal(kBadGarment, where + ": 'name' is empty");
  if (node["ratio"])
    line.ratio = geometry::number_in(node, "ratio", kLowestRatio, kHighestRatio, where, kBadGarment);
  line.law = read_law(node, where);
  if (node["tension_limit"])
    line.tension_limit = geometry::number_in(node, "tension_limit", 0, kHighestTension, where, kBadGarment);
  line.through = words(node, "through", where);
  if (line.through.size() == 1) throw Refusal(kBadGarment, where + ": 'through' needs two nodes or more");
  const auto follow = geometry::optional<std::string>(node, "follow", "skin", where, kBadGarment);
  if (follow != "skin" && follow != "taut")
    throw Refusal(kBadGarment, where + ": 'follow' is '" + follow + "', not skin or taut");
  line.taut = follow == "taut";
  if (node["points"]) {
    line.points = read_points(node, where);
    if (!line.through.empty()) throw Refusal(kBadGarment, where + ": has both 'through' and 'points'");
  }
  if (!line.through.empty()) line.width = kBandWidth;
  if (node["width"]) line.width = geometry::number_in(node, "width", 0, kWidestBand, where, kBadGarment);
  if (!line.through.empty() && line.width > 0) line.smooth = kBandSmooth;
  if (node["smooth"]) line.smooth = geometry::number_in(node, "smooth", 0, kWidestBand, where, kBadGarment);
  if (line.smooth > 0 && !line.on_body())
    throw Refusal(kBadGarment, where + ": 'smooth' is for bands and for lines that are given by 'points'");
  if (node["ends"]) {
    if (line.points.empty())
      throw Refusal(kBadGarment, where +
                                     ": 'ends' is for lines that are given by 'points'; a line by "
                                     "'through' ends as its last node does");
    line.held =
        held_in(geometry::required<std::vector<std::string>>(node, "ends", where, kBadGarment), where);
  }
  return line;
}

bool has_line(const Garment& garment, const std::string& name) {
  return std::any_of(garment.lines.begin(), garment.lines.end(),
                     [&name](const GarmentLine& line) { return line.name == name; });
}

}  // namespace

std::array<bool, 2> held_in(const std::vector<std::string>& words, const std::string& where) {
  if (words.size() != 2) throw Refusal(kBadGarment, where + ": 'ends' must be two words, one per end");
  for (const std::string& word : words)
    if (word != kHeldByBone && word != kCarriedBySkin)
      throw Refusal(kBadGarment,
                    where + ": an end is '" + word + "', neither " + kHeldByBone + " nor " + kCarriedBySkin);
  return {words[0] == kHeldByBone, words[1] == kHeldByBone};
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
  std::error_code no_file;
  if (std::filesystem::is_regular_file(words, no_file) || words.find('+') == std::string::npos)
    return load_garment(geometry::yaml_file(folder, words, kBadGarment));
  Garment all;
  all.name = words;
  for (std::size_t start = 0; start <= words.size();) {
    const std::size_t end = std::min(words.find('+', start), words.size());
    const Garment one =
        load_garment(geometry::yaml_file(folder, words.substr(start, end - start), kBadGarment));
    for (const std::string& region : one.regions)
      if (std::find(all.regions.begin(), all.regions.end(), region) == all.regions.end())
        all.regions.push_back(region);
    for (const GarmentLine& line : one.lines) {
      if (has_line(all, line.name))
        throw Refusal(kBadGarment, "of " + words + " two garments have a line '" + line.name + "'");
      all.lines.push_back(line);
    }
    start = end + 1;
  }
  return all;
}

void set_ratio(Garment& garment, const std::string& line, double ratio) {
  if (!(ratio >= kLowestRatio && ratio <= kHighestRatio)) {
    std::ostringstream what;
    what << "ratio " << ratio << " is outside [" << kLowestRatio << ", " << kHighestRatio << "]";
    throw Refusal(kBadGarment, what.str());
  }
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
