#include "case.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "geometry/checked_yaml.hpp"
#include "geometry/shipped_files.hpp"
#include "tensegric/fit_messages.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;
using geometry::Refusal;

Value value_in(const YAML::Node& node, const std::string& where) {
  if (!node.IsScalar()) throw Refusal(kBadCase, where + ": is neither a number nor a word");
  double number = 0;
  if (!YAML::convert<double>::decode(node, number)) return node.Scalar();
  if (!std::isfinite(number)) throw Refusal(kBadCase, where + ": is not finite");
  return number;
}

Expectation read_expectation(const std::string& metric, const YAML::Node& map, const std::string& where) {
  geometry::check_keys(map, {"expected", "golden", "tolerance", "reason"}, where, kBadCase);
  if (bool(map["expected"]) == bool(map["golden"]))
    throw Refusal(kBadCase, where + ": needs either 'expected' or 'golden'");
  Expectation expectation;
  expectation.metric = metric;
  expectation.golden = bool(map["golden"]);
  const YAML::Node value = expectation.golden ? map["golden"] : map["expected"];
  if (!value.IsNull()) expectation.value = value_in(value, where);
  if (!expectation.golden && !expectation.value) throw Refusal(kBadCase, where + ": 'expected' is empty");
  expectation.tolerance = geometry::optional(map, "tolerance", 0.0, where, kBadCase);
  if (!std::isfinite(expectation.tolerance)) throw Refusal(kBadCase, where + ": 'tolerance' is not finite");
  if (expectation.tolerance < 0) throw Refusal(kBadCase, where + ": 'tolerance' is negative");
  expectation.reason = geometry::required<std::string>(map, "reason", where, kBadCase);
  return expectation;
}

// Those of one file replace earlier ones of the same name.
void add_expectations(const YAML::Node& metrics, const std::string& where, std::vector<Expectation>& all) {
  if (!metrics) return;
  if (!metrics.IsMap()) throw Refusal(kBadCase, where + ": 'metrics' must be a map");
  std::set<std::string> here;
  for (const auto& entry : metrics) {
    const std::string name = entry.first.Scalar();
    if (!here.insert(name).second) throw Refusal(kBadCase, where + ": '" + name + "' is given twice");
    const Expectation expectation = read_expectation(name, entry.second, where + ": " + name);
    const auto same = [&](const Expectation& e) { return e.metric == name; };
    const auto known = std::find_if(all.begin(), all.end(), same);
    if (known == all.end())
      all.push_back(expectation);
    else
      *known = expectation;
  }
}

Garment read_garment(const YAML::Node& node, const std::string& where) {
  const std::string shipped = geometry::shipped_folder("garments");
  if (node.IsScalar()) return node::to_message({}, {tensegric::take_garment(node.Scalar(), shipped), ""});
  geometry::check_keys(node, {"name", "ratio", "ratios", "stiffness"}, where, kBadCase);
  const auto name = geometry::required<std::string>(node, "name", where, kBadCase);
  node::GarmentRequest request{tensegric::take_garment(name, shipped), ""};
  if (node["ratio"])
    tensegric::set_ratio(request.garment, "", geometry::required<double>(node, "ratio", where, kBadCase));
  using Ratios = std::map<std::string, double>;
  for (const auto& [line, ratio] : geometry::optional(node, "ratios", Ratios(), where, kBadCase))
    tensegric::set_ratio(request.garment, line, ratio);
  Garment garment = node::to_message({}, request);
  if (node["stiffness"])
    for (GarmentLine& line : garment.lines) {
      line.law = GarmentLine::STIFFNESS;
      line.stiffness = geometry::required<double>(node, "stiffness", where, kBadCase);
    }
  return garment;
}

std::vector<Garment> garments_in(const std::string& path) {
  std::vector<Garment> garments;
  const rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::datatype<Garment>()));
  for (const rosbag::MessageInstance& message : view)
    if (const auto garment = message.instantiate<Garment>()) garments.push_back(*garment);
  return garments;
}

void read_garments(const YAML::Node& root, Case& read) {
  const std::string where = read.file + ": garments";
  if (!root["garments"]) return;
  if (root["garments"].IsScalar() && root["garments"].Scalar() == "recorded" && !read.bag.empty()) {
    read.own_garments = true;
    read.garments = read_bag(read.bag, [&read] { return garments_in(read.bag); });
    return;
  }
  if (!root["garments"].IsSequence()) throw Refusal(kBadCase, where + ": must be a list, or 'recorded'");
  for (const YAML::Node& node : root["garments"]) {
    read.garments.push_back(read_garment(node, where));
    if (read.garments.size() > 1) read.garments.back().name += fmt::format(" #{}", read.garments.size());
  }
}

void read_scene(const YAML::Node& root, Case& read) {
  const auto scene = geometry::required<std::string>(root, "scene", read.file, kBadCase);
  const bool known = scene == "measure" || scene == "bust" || scene == "hips" || scene == "bust+hips";
  if (!known)
    throw Refusal(kBadCase, read.file + ": scene '" + scene + "' is not measure, bust, hips or bust+hips");
  if ((scene == "measure") != read.measure_only())
    throw Refusal(kBadCase, read.file + ": a scene has garments, but for 'measure'");
  if (scene != "measure") read.pipeline["control_mesh"]["template"] = scene;
}

void read_updates(const YAML::Node& updates, Case& read) {
  const std::string where = read.file + ": updates";
  if (updates && !updates.IsSequence()) throw Refusal(kBadCase, where + ": must be a list");
  for (const YAML::Node& node : updates) {
    if (node.IsScalar()) {
      read.updates.push_back({node.Scalar(), {}, {}, {}});
      continue;
    }
    geometry::check_keys(node, {"date", "commit", "reason", "values"}, where, kBadCase);
    using Pair = std::pair<std::string, std::string>;
    read.updates.push_back(
        {geometry::required<std::string>(node, "reason", where, kBadCase),
         geometry::required<std::string>(node, "date", where, kBadCase),
         geometry::required<std::string>(node, "commit", where, kBadCase),
         geometry::optional(node, "values", std::map<std::string, Pair>(), where, kBadCase)});
  }
}

}  // namespace

std::string to_text(const Value& value) {
  return std::holds_alternative<double>(value) ? fmt::format("{:.9g}", std::get<double>(value))
                                               : std::get<std::string>(value);
}

Case load_case(const std::string& file) {
  const YAML::Node root = geometry::load_yaml_map(file, kBadCase);
  geometry::check_keys(
      root, {"about", "booth", "bag", "scene", "pipeline", "garments", "expect", "metrics", "updates"}, file,
      kBadCase);
  Case read;
  read.file = file;
  read.name = fs::path(file).stem();
  read.about = geometry::required<std::string>(root, "about", file, kBadCase);
  if (bool(root["booth"]) == bool(root["bag"]))
    throw Refusal(kBadCase, file + ": needs either 'booth' or 'bag'");
  if (root["booth"]) read.booth = read_recipe(root["booth"], file + ": booth");
  if (root["bag"]) {
    read.bag = fs::path(file).parent_path() / geometry::required<std::string>(root, "bag", file, kBadCase);
    std::error_code unreadable;
    if (!fs::is_regular_file(read.bag, unreadable))
      throw Refusal(kBadCase, file + ": there is no bag " + read.bag);
  }
  read.pipeline = YAML::Clone(root["pipeline"] ? root["pipeline"] : YAML::Node(YAML::NodeType::Map));
  geometry::check_keys(read.pipeline,
                       {"assembler", "reconstruction", "landmarks", "control_mesh", "tensegric", "tffd"},
                       file + ": pipeline", kBadCase);
  read_garments(root, read);
  read_scene(root, read);
  for (const std::string& set :
       geometry::optional(root, "expect", std::vector<std::string>(), file, kBadCase)) {
    const std::string path = fs::path(file).parent_path() / "expect" / (set + ".yaml");
    add_expectations(geometry::load_yaml_map(path, kBadCase), path, read.expectations);
  }
  add_expectations(root["metrics"], file, read.expectations);
  if (read.expectations.empty()) throw Refusal(kBadCase, file + ": nothing is expected");
  read_updates(root["updates"], read);
  return read;
}

std::vector<Case> load_cases(const std::string& folder, const std::vector<std::string>& names) {
  std::vector<std::string> files;
  for (const std::string& name : names) files.push_back(geometry::yaml_file(folder, name, kBadCase));
  if (names.empty())
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  if (files.empty()) throw Refusal(kBadCase, folder + ": holds no cases");
  std::sort(files.begin(), files.end());
  std::vector<Case> cases;
  for (const std::string& file : files) cases.push_back(load_case(file));
  return cases;
}

}  // namespace tensegric_fit::regression
