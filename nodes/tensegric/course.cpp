#include "tensegric/course.hpp"

#include <algorithm>
#include <set>

#include "geometry/status.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

/// 'L' or 'R' of a name with such an ending, else 0.
char side_of(const std::string& name) {
  const bool sided = name.size() > 2 && name[name.size() - 2] == '_';
  return sided && (name.back() == 'L' || name.back() == 'R') ? name.back() : '\0';
}

std::set<char> sides_of(const std::vector<std::string>& names) {
  std::set<char> sides;
  for (const std::string& name : names)
    if (const char side = side_of(name)) sides.insert(side);
  return sides;
}

// A strap may cross her back; a line whose every sided node is of the other side was mistaken for its mirror
// image. A cup lies on one side: its name's, and that from which it comes.
void check_side(const GarmentLine& line) {
  const auto refuse = [&line](const std::string& what) {
    throw Refusal(refusal::kBadGarment, "line '" + line.name + "' " + what);
  };
  const std::set<char> through = sides_of(line.through), fan = sides_of(line.fan);
  if (const char side = side_of(line.name)) {
    const char other = side == 'L' ? 'R' : 'L';
    const std::string words = other == 'L' ? "left" : "right";
    if (through == std::set{other}) refuse("runs over the " + words + " side only");
    if (!line.fan.empty() && through.count(other) + fan.count(other) > 0)
      refuse("is a cup that lies on the " + words + " side");
  }
  if (through.size() == 1 && fan.size() == 1 && through != fan)
    refuse("is a cup that begins on one side and spreads on the other");
}

std::vector<int> stops_of(const geometry::ControlMesh& control, const GarmentLine& line,
                          const std::vector<std::string>& names) {
  std::vector<int> stops;
  for (const std::string& name : names) {
    const int node = control.node(name);
    if (node < 0)
      throw Refusal(refusal::kUnknownLine, "line '" + line.name + "' runs through '" + name +
                                               "', which the control mesh does not have");
    if (!stops.empty() && stops.back() == node)
      throw Refusal(refusal::kBadGarment,
                    "line '" + line.name + "' runs through '" + name + "' twice in a row");
    stops.push_back(node);
  }
  return stops;
}

// Its nodes, of a cup down to where its fibres spread. A taut string goes straight from stop to stop; a taut
// band is pulled off the skin between them.
std::vector<int> stem_of(const geometry::ControlMesh& control, const GarmentLine& line) {
  std::vector<int> nodes;
  if (!line.through.empty()) {
    check_side(line);
    nodes = stops_of(control, line, line.through);
    if (!line.taut || line.on_body()) nodes = geometry::route_over_edges(control, nodes, line.name);
  } else {
    const auto own =
        std::find_if(control.lines.begin(), control.lines.end(),
                     [&line](const geometry::ControlLine& one) { return one.name == line.name; });
    if (own == control.lines.end())
      throw Refusal(refusal::kUnknownLine, "the control mesh has no line '" + line.name + "'");
    nodes = own->nodes;
  }
  if (nodes.size() < 2 && line.fan.empty())
    throw Refusal(refusal::kBadGarment, "line '" + line.name + "' has fewer than two nodes");
  return nodes;
}

// The row of nodes on which a cup's fibres end.
std::vector<int> row_of(const geometry::ControlMesh& control, const GarmentLine& line, int from) {
  std::vector<int> row = geometry::route_over_edges(control, stops_of(control, line, line.fan), line.name);
  if (std::find(row.begin(), row.end(), from) != row.end())
    throw Refusal(refusal::kBadGarment, "line '" + line.name + "' ends in a row over '" +
                                            line.through.back() + "', from which its fibres spread");
  return row;
}

std::vector<Eigen::Vector3d> places_of(const geometry::ControlMesh& control, const std::vector<int>& nodes) {
  std::vector<Eigen::Vector3d> places;
  for (const int node : nodes) places.push_back(control.outer[node]);
  return places;
}

}  // namespace

std::vector<int> nodes_of(const geometry::ControlMesh& control, const GarmentLine& line) {
  std::vector<int> nodes = stem_of(control, line);
  if (line.fan.empty()) return nodes;
  const std::vector<int> row = row_of(control, line, nodes.back());
  const std::vector<int> on =
      geometry::route_over_edges(control, {nodes.back(), row[row.size() / 2]}, line.name);
  nodes.insert(nodes.end(), on.begin() + 1, on.end());
  return nodes;
}

Course course_of(const geometry::ControlMesh& control, const GarmentLine& line) {
  if (!line.points.empty()) return {line.points, line.held};
  const std::vector<int> nodes = stem_of(control, line);
  const auto fixed = [&control](int node) { return control.outer_fixed[node] != 0; };
  Course course{places_of(control, nodes), {fixed(nodes.front()), fixed(nodes.back())}};
  if (line.fan.empty()) return course;
  const std::vector<int> row = row_of(control, line, nodes.back());
  course.held[1] = std::all_of(row.begin(), row.end(), fixed);
  for (const int node : row)
    course.fan.push_back(
        places_of(control, geometry::route_over_edges(control, {nodes.back(), node}, line.name)));
  return course;
}

}  // namespace tensegric_fit::tensegric
