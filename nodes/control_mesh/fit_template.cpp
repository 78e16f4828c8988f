#include "control_mesh/fit_template.hpp"

#include <algorithm>
#include <limits>

#include "control_mesh/grid.hpp"
#include "control_mesh/inner_nodes.hpp"
#include "control_mesh/placing.hpp"
#include "control_mesh/relax.hpp"
#include "control_mesh/skin.hpp"
#include "control_mesh/subdivide.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr int kMostTriangles = 200000;

geometry::TriangleMesh in_body_frame(const geometry::TriangleMesh& body,
                                     const Eigen::Isometry3d& body_from_scan) {
  geometry::TriangleMesh moved = body;
  for (Vector3d& p : moved.vertices) p = body_from_scan * p;
  return moved;
}

std::vector<double> thickness_of(const Template& pattern) {
  std::vector<double> thickness(static_cast<std::size_t>(pattern.rows) * pattern.columns);
  for (const Side side : {Side::left, Side::right})
    for (int row = 0; row < pattern.rows; ++row)
      for (int column = 0; column <= pattern.middle(); ++column)
        thickness[node_at(pattern, row, column, side)] = pattern.thickness[row][column];
  return thickness;
}

/// Nodes that the template does not place, but for the rim.
std::vector<char> movable(const Template& pattern) {
  std::vector<char> may_move(static_cast<std::size_t>(pattern.rows) * pattern.columns, 1);
  for (const Side side : {Side::left, Side::right}) {
    for (const TemplateNode& node : pattern.nodes)
      if (node.placing != TemplateNode::Placing::between_others)
        may_move[node_at(pattern, node.row, node.column, side)] = 0;
    for (int row = 0; row < pattern.rows; ++row)
      for (int column = 0; column <= pattern.middle(); ++column)
        if (row == 0 || row == pattern.rows - 1 || column == 0)
          may_move[node_at(pattern, row, column, side)] = 0;
  }
  return may_move;
}

std::vector<std::vector<int>> grid_neighbours(const Template& pattern) {
  std::vector<std::vector<int>> around;
  for (int row = 0; row < pattern.rows; ++row)
    for (int column = 0; column < pattern.columns; ++column) {
      const int node = row * pattern.columns + column;
      around.emplace_back();
      if (row > 0) around.back().push_back(node - pattern.columns);
      if (row + 1 < pattern.rows) around.back().push_back(node + pattern.columns);
      if (column > 0) around.back().push_back(node - 1);
      if (column + 1 < pattern.columns) around.back().push_back(node + 1);
    }
  return around;
}

/// Columns may go round the trunk either way (over the front or over the back): triangles face away from the
/// axis.
void face_outward(geometry::ControlMesh& control, const Vector3d& axis) {
  double outward = 0;
  for (const Eigen::Vector3i& k : control.triangles) {
    const Vector3d &a = control.outer[k[0]], &b = control.outer[k[1]], &c = control.outer[k[2]];
    Vector3d radial = (a + b + c) / 3 - axis;
    radial.z() = 0;
    outward += radial.dot(geometry::area_vector(a, b, c));
  }
  if (outward < 0)
    for (Eigen::Vector3i& k : control.triangles) std::swap(k[1], k[2]);
}

void add_lines(const Template& pattern, geometry::ControlMesh& control) {
  for (const TemplateLine& line : pattern.lines) {
    std::vector<int> stops;
    for (const std::string& stop : line.through) stops.push_back(control.node(stop));
    control.lines.push_back({line.name, geometry::route_over_edges(control, stops)});
  }
}

}  // namespace

geometry::ControlMesh fit_template(const Template& pattern, const geometry::TriangleMesh& body,
                                   const geometry::BodyMeasures& measures, const Options& options) {
  if (options.control_triangles < 1 || options.control_triangles > kMostTriangles)
    throw Refusal(refusal::kBadOption, "control_triangles is " + std::to_string(options.control_triangles) +
                                           ", outside [1, " + std::to_string(kMostTriangles) + "]");
  geometry::check_mesh(body);
  if (body.triangles.empty()) throw Refusal(refusal::kNotABody, "the body mesh has no triangles");

  // 1. Outer nodes on the skin.
  const Skin skin(in_body_frame(body, measures.body_from_scan));
  geometry::ControlMesh control = grid_of(pattern);
  control.outer = place_nodes(pattern, measures, skin);
  face_outward(control, trunk_axis(pattern, measures));
  relax_on_skin(control, movable(pattern), grid_neighbours(pattern), skin);

  // 2. Inner nodes below them.
  place_inner_nodes(control, thickness_of(pattern), skin);

  // 3. Constraining lines, then finer triangles where they are asked for.
  add_lines(pattern, control);
  while (control.triangles.size() < static_cast<std::size_t>(options.control_triangles))
    control = subdivide(control, skin);

  // 4. Back to the scan's frame.
  const Eigen::Isometry3d scan_from_body = measures.body_from_scan.inverse();
  for (Vector3d& p : control.outer) p = scan_from_body * p;
  for (Vector3d& p : control.inner) p = scan_from_body * p;
  geometry::check_control_mesh(control);
  return control;
}

}  // namespace tensegric_fit::control_mesh
