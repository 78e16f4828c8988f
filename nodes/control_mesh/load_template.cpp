#include <algorithm>
#include <cmath>
#include <set>

#include "control_mesh/grid.hpp"
#include "control_mesh/template.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using geometry::check_keys;
using geometry::number_in;
using geometry::optional;
using geometry::Refusal;
using geometry::required;
constexpr const char* kCode = geometry::refusal::kBadTemplate;
constexpr int kMostRows = 100;
constexpr int kMostRegions = 64, kMostLines = 1000, kMostStops = 1000;
constexpr double kThinnestTissue = 0.001, kThickestTissue = 0.2;  // m
constexpr double kLeastDepthShare = 0.1;                          // of the way to bone
constexpr int kMostVertices = 1 << 16;                            // of a model file: its quads are uint16
constexpr double kRounded = 0.001;                                // shares are written with a few digits

bool ends_in(const std::string& word, const char* ending) {
  return word.size() > 2 && word.compare(word.size() - 2, 2, ending) == 0;
}

int whole_number(const YAML::Node& map, const char* key, int low, int high, const std::string& where) {
  number_in(map, key, low, high, where, kCode);
  return required<int>(map, key, where, kCode);
}

/// A slip in a name would look like a landmark that is missing on every body.
void check_landmark(const std::string& name, const std::string& key, const std::string& where) {
  if (!geometry::is_landmark(name))
    throw Refusal(kCode, where + ": '" + key + "' has '" + name + "', which is the name of no landmark");
}

std::string landmark_in(const YAML::Node& map, const char* key, const std::string& where) {
  const auto name = required<std::string>(map, key, where, kCode);
  check_landmark(name, key, where);
  return name;
}

/// What levels and angles have in common.
Reference reference_from(const YAML::Node& map, double most_offset, const std::string& where) {
  Reference reference;
  if (map["between"]) {
    const auto ends = required<std::vector<std::string>>(map, "between", where, kCode);
    if (ends.size() != 2 || map["landmark"])
      throw Refusal(kCode, where + ": give one 'landmark', or 'between' with two landmarks and 'at'");
    for (const std::string& end : ends) check_landmark(end, "between", where);
    reference.landmark = ends[0];
    reference.towards = ends[1];
    reference.at = number_in(map, "at", -2, 3, where, kCode);
  } else {
    reference.landmark = landmark_in(map, "landmark", where);
    if (map["at"]) throw Refusal(kCode, where + ": 'at' needs 'between'");
  }
  if (map["offset"]) reference.offset = number_in(map, "offset", -most_offset, most_offset, where, kCode);
  return reference;
}

Reference level_from(const YAML::Node& map, const std::string& where) {
  check_keys(map, {"landmark", "between", "at", "offset", "below", "by"}, where, kCode);
  Reference level = reference_from(map, 0.5, where);
  if (map["by"] && !map["below"]) throw Refusal(kCode, where + ": 'by' needs 'below'");
  if (!map["below"]) return level;
  level.below = landmark_in(map, "below", where);
  level.by = number_in(map, "by", 0, 0.5, where, kCode);
  return level;
}

Reference angle_from(const YAML::Node& map, bool on_middle, const std::string& where) {
  check_keys(map, {"landmark", "between", "at", "offset"}, where, kCode);
  Reference angle = reference_from(map, 180, where);
  if (on_middle && angle.offset != 0)
    throw Refusal(kCode, where + ": 'offset' goes to either side alike: none on the middle column");
  return angle;
}

std::vector<std::string> axis_from(const YAML::Node& map, const std::string& where) {
  const auto axis = required<std::vector<std::string>>(map, "axis", where, kCode);
  if (axis.empty()) throw Refusal(kCode, where + ": 'axis' must name a landmark");
  for (const std::string& landmark : axis) check_landmark(landmark, "axis", where);
  return axis;
}

/// [[vertex or name, share], ...]; shares are brought to the sum 1 exactly.
std::vector<ModelPoint> model_points_from(const YAML::Node& node, const std::string& key,
                                          const std::string& where) {
  const YAML::Node list = node[key];
  const auto refuse = [&](const std::string& what) {
    throw Refusal(kCode, where + ": '" + key + "' " + what);
  };
  if (!list.IsSequence() || list.size() == 0)
    refuse("must be a list of pairs, each a vertex number or the name of a skin point, and its share");
  constexpr std::size_t kMost = 64;  // a corner of the skin needs three
  if (list.size() > kMost) refuse("must have 64 pairs at most");
  std::vector<ModelPoint> points;
  double sum = 0;
  for (const YAML::Node& pair : list) {
    if (!pair.IsSequence() || pair.size() != 2 || !pair[0].IsScalar())
      refuse("must be a list of pairs, each a vertex number or the name of a skin point, and its share");
    ModelPoint point;
    double number = 0;
    if (!YAML::convert<double>::decode(pair[0], number))
      point.name = pair[0].Scalar();
    else if (!YAML::convert<int>::decode(pair[0], point.vertex) || point.vertex < 0 ||
             point.vertex >= kMostVertices)
      refuse("has '" + pair[0].Scalar() + "' for a vertex, no whole number in [0, " +
             std::to_string(kMostVertices - 1) + "]");
    if (!YAML::convert<double>::decode(pair[1], point.share) || !(point.share > 0 && point.share <= 1))
      refuse("must give '" + pair[0].Scalar() + "' a share above 0, and 1 at most");
    for (const ModelPoint& other : points)
      if (other.name == point.name && other.vertex == point.vertex)
        refuse("has '" + pair[0].Scalar() + "' twice");
    sum += point.share;
    points.push_back(point);
  }
  if (std::abs(sum - 1) > kRounded * static_cast<double>(points.size()))
    refuse("has shares that sum to " + std::to_string(sum) + ", not to 1");
  for (ModelPoint& point : points) point.share /= sum;
  return points;
}

TemplateNode node_from(const YAML::Node& map, const Template& pattern, const std::string& where) {
  check_keys(
      map,
      {"row", "column", "name", "spread", "landmark", "level", "angle", "axis", "on_model", "or_on_model"},
      where, kCode);
  TemplateNode node;
  node.row = whole_number(map, "row", 0, pattern.rows - 1, where);
  node.column = whole_number(map, "column", 0, pattern.middle(), where);
  node.name = optional<std::string>(map, "name", "", where, kCode);
  const bool on_middle = node.column == pattern.middle();
  if (!node.name.empty() && (ends_in(node.name, "_R") || ends_in(node.name, "_L") == on_middle))
    throw Refusal(kCode, where + ": 'name' must end in _L, and on the middle column must not");
  if (map["on_model"]) {
    node.placing = TemplateNode::Placing::on_model;
    node.on_model = model_points_from(map, "on_model", where);
    for (const char* other : {"landmark", "level", "angle", "or_on_model"})
      if (map[other]) throw Refusal(kCode, where + ": 'on_model' excludes '" + other + "'");
  } else if (map["landmark"]) {
    node.placing = TemplateNode::Placing::at_landmark;
    node.landmark = landmark_in(map, "landmark", where);
    if (map["level"] || map["angle"])
      throw Refusal(kCode, where + ": 'landmark' excludes 'level' and 'angle'");
  } else if (map["level"] || map["angle"]) {
    node.placing = TemplateNode::Placing::level_and_angle;
    if (!map["level"] || !map["angle"]) throw Refusal(kCode, where + ": 'level' and 'angle' go together");
    node.level = level_from(map["level"], where + ", level");
    node.angle = angle_from(map["angle"], on_middle, where + ", angle");
  } else if (node.name.empty() && !map["or_on_model"]) {
    throw Refusal(kCode, where + ": neither a 'name' nor a place");
  }
  node.spread =
      optional(map, "spread", node.placing == TemplateNode::Placing::between_others && node.name.empty(),
               where, kCode);
  if (map["spread"] && node.placing != TemplateNode::Placing::between_others)
    throw Refusal(kCode, where + ": 'spread' is for a node without a place");
  if (map["or_on_model"]) node.or_on_model = model_points_from(map, "or_on_model", where);
  if (map["axis"]) {
    if (node.placing != TemplateNode::Placing::level_and_angle || on_middle)
      throw Refusal(kCode, where + ": 'axis' needs 'level' and 'angle', and a node off the middle column");
    node.axis = axis_from(map, where);
  }
  return node;
}

/// A picture of her left half: one word a row, made of the given characters.
std::vector<std::string> picture(const YAML::Node& root, const char* key, int rows, int columns,
                                 const std::string& characters, const std::string& path) {
  const auto lines = required<std::vector<std::string>>(root, key, path, kCode);
  const auto fits = [&](const std::string& line) {
    return line.size() == static_cast<std::size_t>(columns) &&
           line.find_first_not_of(characters) == std::string::npos;
  };
  if (lines.size() != static_cast<std::size_t>(rows) || !std::all_of(lines.begin(), lines.end(), fits))
    throw Refusal(kCode, path + ": '" + key + "' must be " + std::to_string(rows) + " words of " +
                             std::to_string(columns) + " of the characters '" + characters + "'");
  return lines;
}

double metres(const YAML::Node& node, const char* key, const std::string& where) {
  required<double>(node, key, where, kCode);
  return geometry::number_in(node, key, kThinnestTissue, kThickestTissue, where, kCode);
}

double share_from(const YAML::Node& node, const std::string& where) {
  required<double>(node, "share", where, kCode);
  return geometry::number_in(node, "share", kLeastDepthShare, 1, where, kCode);
}

BoneRule bone_from(const YAML::Node& node, const std::string& where) {
  check_keys(node, {"inset", "least", "share"}, where, kCode);
  return {metres(node, "inset", where), metres(node, "least", where), share_from(node, where)};
}

CushionRule cushion_from(const YAML::Node& node, const Template& pattern, const std::string& where) {
  check_keys(node, {"depth", "more", "reach", "cleft", "at", "share"}, where, kCode);
  CushionRule rule{metres(node, "depth", where), metres(node, "more", where),
                   metres(node, "reach", where), metres(node, "cleft", where),
                   share_from(node, where),      required<std::string>(node, "at", where, kCode)};
  if (!ends_in(rule.at, "_L") || std::none_of(pattern.nodes.begin(), pattern.nodes.end(),
                                              [&rule](const TemplateNode& n) { return n.name == rule.at; }))
    throw Refusal(kCode, where + ": 'at' must be a node of the template that ends in _L");
  return rule;
}

std::vector<std::vector<double>> thickness_from(const YAML::Node& root, const Template& pattern,
                                                const std::string& path) {
  const auto table = required<std::vector<std::vector<double>>>(root, "thickness", path, kCode);
  bool fits = table.size() == static_cast<std::size_t>(pattern.rows);
  for (const auto& row : table) {
    fits = fits && row.size() == static_cast<std::size_t>(pattern.middle()) + 1;
    for (double metres : row) fits = fits && metres >= kThinnestTissue && metres <= kThickestTissue;
  }
  if (!fits)
    throw Refusal(kCode, path + ": 'thickness' must be " + std::to_string(pattern.rows) + " rows of " +
                             std::to_string(pattern.middle() + 1) + " lengths of 0.001 to 0.2 m");
  return table;
}

TemplateRegion region_from(const YAML::Node& map, const Template& pattern, const std::string& where) {
  check_keys(map, {"name", "rows", "columns"}, where, kCode);
  const auto span = [&](const char* key, int count) {
    const auto ends = required<std::vector<int>>(map, key, where, kCode);
    if (ends.size() != 2 || ends[0] < 0 || ends[0] >= ends[1] || ends[1] >= count)
      throw Refusal(kCode,
                    where + ": '" + key + "' must be two ascending numbers below " + std::to_string(count));
    return ends;
  };
  const auto rows = span("rows", pattern.rows), columns = span("columns", pattern.columns);
  return {required<std::string>(map, "name", where, kCode), rows[0], rows[1], columns[0], columns[1]};
}

YAML::Node list_of(const YAML::Node& root, const char* key, int most, const std::string& path) {
  if (!root[key] || !root[key].IsSequence() || root[key].size() == 0)
    throw Refusal(kCode, path + ": '" + key + "' must be a list with something in it");
  if (root[key].size() > static_cast<std::size_t>(most))
    throw Refusal(kCode, path + ": '" + key + "' must have " + std::to_string(most) + " entries at most");
  return root[key];
}

/// Cells hang together along edges: one run of them in each row and each column, each row's over the next
/// one's.
void check_shape(const Template& pattern, const std::string& path) {
  const int rows = pattern.rows - 1, columns = pattern.middle();
  const auto drawn = [&](int row, int column) { return pattern.diagonals[row][column] != ' '; };
  const auto one_run = [](int count, const auto& is_cell) {
    int runs = 0;
    for (int i = 0; i < count; ++i)
      if (is_cell(i) && (i == 0 || !is_cell(i - 1))) ++runs;
    return runs == 1;
  };
  bool one_piece = true;
  for (int column = 0; column < columns; ++column)
    one_piece = one_piece && one_run(rows, [&](int row) { return drawn(row, column); });
  for (int row = 0; row < rows; ++row) {
    one_piece = one_piece && one_run(columns, [&](int column) { return drawn(row, column); });
    bool meets_next = row + 1 == rows;
    for (int column = 0; column < columns && !meets_next; ++column)
      meets_next = drawn(row, column) && drawn(row + 1, column);
    one_piece = one_piece && meets_next;
  }
  if (!one_piece)
    throw Refusal(kCode, path +
                             ": 'diagonals' must leave each row and each column one piece of cells, and each "
                             "row an edge with the next one");
}

/// Every node must be reachable: each column has both ends placed, or in a row whose own ends are, and no
/// node stands there twice.
void check_nodes(const Template& pattern, const std::string& path) {
  std::set<std::pair<int, int>> places, placed;
  std::set<std::string> names;
  for (const TemplateNode& node : pattern.nodes) {
    const std::string place = "row " + std::to_string(node.row) + ", column " + std::to_string(node.column);
    if (!places.insert({node.row, node.column}).second ||
        (!node.name.empty() && !names.insert(node.name).second))
      throw Refusal(kCode, path + ": 'nodes' has " + place + " or the name '" + node.name + "' twice");
    if (node_at(pattern, node.row, node.column, Side::left) < 0)
      throw Refusal(kCode, path + ": 'nodes' has " + place + ", which no cell touches");
    if (node.placing != TemplateNode::Placing::between_others) placed.insert({node.row, node.column});
  }
  const auto exists = [&](int row, int column) {
    return row >= 0 && row < pattern.rows && node_at(pattern, row, column, Side::left) >= 0;
  };
  const auto row_is_filled = [&](int row) {
    int first = 0, last = pattern.middle();
    while (!exists(row, first)) ++first;
    while (!exists(row, last)) --last;
    return placed.count({row, first}) > 0 && placed.count({row, last}) > 0;
  };
  for (int row = 0; row < pattern.rows; ++row)
    for (int column = 0; column <= pattern.middle(); ++column) {
      const bool end_of_column =
          exists(row, column) && (!exists(row - 1, column) || !exists(row + 1, column));
      if (end_of_column && placed.count({row, column}) == 0 && !row_is_filled(row))
        throw Refusal(kCode, path + ": 'nodes' must place row " + std::to_string(row) + ", column " +
                                 std::to_string(column) + ", or both ends of that row");
    }
}

void check_regions(const Template& pattern, const std::string& path) {
  std::set<std::string> names;
  for (const TemplateRegion& region : pattern.regions)
    if (!names.insert(region.name).second)
      throw Refusal(kCode, path + ": 'regions' has the name '" + region.name + "' twice");
  for (const geometry::ControlRegion& region : grid_of(pattern).regions)
    if (region.triangles.empty())
      throw Refusal(kCode, path + ": region '" + region.name + "' has no cell that 'diagonals' draws");
}

void check_lines(const Template& pattern, const std::string& path) {
  std::set<std::string> names, lines;
  for (const TemplateNode& node : pattern.nodes) {
    if (node.name.empty()) continue;
    names.insert(node.name);
    if (ends_in(node.name, "_L")) names.insert(node.name.substr(0, node.name.size() - 1) + "R");
  }
  for (const TemplateLine& line : pattern.lines) {
    if (!lines.insert(line.name).second)
      throw Refusal(kCode, path + ": 'lines' has the name '" + line.name + "' twice");
    if (line.through.size() > static_cast<std::size_t>(kMostStops))
      throw Refusal(kCode, path + ": line '" + line.name + "' must have " + std::to_string(kMostStops) +
                               " nodes in 'through' at most");
    if (line.through.size() < 2)
      throw Refusal(kCode, path + ": line '" + line.name + "' needs two nodes in 'through'");
    for (const std::string& stop : line.through)
      if (names.count(stop) == 0)
        throw Refusal(kCode, path + ": line '" + line.name + "': 'through' has no such node '" + stop + "'");
    if (std::adjacent_find(line.through.begin(), line.through.end()) != line.through.end())
      throw Refusal(kCode, path + ": line '" + line.name + "': 'through' has a node twice in a row");
  }
}

}  // namespace

bool Template::may_use_model() const {
  return std::any_of(nodes.begin(), nodes.end(),
                     [](const TemplateNode& node) { return !node.or_on_model.empty(); });
}

bool Template::needs_model() const {
  return std::any_of(nodes.begin(), nodes.end(), [](const TemplateNode& node) {
    return node.placing == TemplateNode::Placing::on_model;
  });
}

Template load_template(const std::string& path) {
  const YAML::Node root = geometry::load_yaml_map(path, kCode);
  check_keys(root,
             {"name", "axis", "axis_foot", "rows", "columns", "nodes", "diagonals", "fixed", "inner_fixed",
              "thickness", "bone", "cushion", "regions", "lines"},
             path, kCode);
  Template pattern;
  pattern.name = required<std::string>(root, "name", path, kCode);
  pattern.axis = axis_from(root, path);
  if (root["axis_foot"]) pattern.axis_foot = landmark_in(root, "axis_foot", path);
  pattern.rows = whole_number(root, "rows", 2, kMostRows, path);
  pattern.columns = whole_number(root, "columns", 3, kMostRows, path);
  if (pattern.columns % 2 == 0)
    throw Refusal(kCode, path + ": 'columns' must be odd: one of them is the middle");

  pattern.diagonals = picture(root, "diagonals", pattern.rows - 1, pattern.middle(), "\\/ ", path);
  pattern.numbers = number_nodes(pattern);
  check_shape(pattern, path);
  for (const YAML::Node& node : list_of(root, "nodes", kMostRows * kMostRows, path))
    pattern.nodes.push_back(
        node_from(node, pattern, path + ", node " + std::to_string(pattern.nodes.size() + 1)));
  check_nodes(pattern, path);
  pattern.fixed = picture(root, "fixed", pattern.rows, pattern.middle() + 1, "#o.", path);
  pattern.inner_fixed = required<bool>(root, "inner_fixed", path, kCode);
  if (bool(root["thickness"]) + bool(root["bone"]) + bool(root["cushion"]) != 1)
    throw Refusal(kCode, path + ": needs one of 'thickness', 'bone' and 'cushion'");
  if (root["bone"])
    pattern.bone = bone_from(root["bone"], path + ": bone");
  else if (root["cushion"])
    pattern.cushion = cushion_from(root["cushion"], pattern, path + ": cushion");
  else
    pattern.thickness = thickness_from(root, pattern, path);
  for (const YAML::Node& region : list_of(root, "regions", kMostRegions, path))
    pattern.regions.push_back(
        region_from(region, pattern, path + ", region " + std::to_string(pattern.regions.size() + 1)));
  check_regions(pattern, path);
  for (const YAML::Node& line : list_of(root, "lines", kMostLines, path)) {
    const std::string where = path + ", line " + std::to_string(pattern.lines.size() + 1);
    check_keys(line, {"name", "through"}, where, kCode);
    pattern.lines.push_back({required<std::string>(line, "name", where, kCode),
                             required<std::vector<std::string>>(line, "through", where, kCode)});
  }
  check_lines(pattern, path);
  return pattern;
}

}  // namespace tensegric_fit::control_mesh
