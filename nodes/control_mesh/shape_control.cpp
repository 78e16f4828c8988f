#include "control_mesh/shape_control.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "control_mesh/inner_nodes.hpp"
#include "control_mesh/skin.hpp"
#include "geometry/checked_yaml.hpp"
#include "geometry/decimate.hpp"
#include "geometry/status.hpp"
#include "geometry/winding_number.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using geometry::Refusal;
constexpr const char* kBadShape = geometry::refusal::kBadTemplate;
constexpr double kShapeThickness = 0.5;  // of the mean edge
constexpr double kNoVolume = 1e-9;       // of its size cubed: a piece of less is flat, and has no inside

Eigen::Vector3d point_at(const YAML::Node& map, const char* key, const std::string& where) {
  const auto xyz = geometry::required<std::vector<double>>(map, key, where, kBadShape);
  if (xyz.size() != 3) throw Refusal(kBadShape, where + ": '" + key + "' must be three numbers");
  return {xyz[0], xyz[1], xyz[2]};
}

double mean_edge(const geometry::TriangleMesh& mesh) {
  double sum = 0;
  const auto edges = geometry::edges_of(mesh);
  for (const geometry::Edge& e : edges) sum += (mesh.vertices[e.first] - mesh.vertices[e.second]).norm();
  return sum / static_cast<double>(edges.size());
}

std::vector<geometry::TriangleMesh> closed_pieces(const geometry::TriangleMesh& mesh) {
  std::vector<std::vector<int>> triangles;  // of each piece
  const std::vector<int> piece_of = geometry::components_of(mesh);
  for (std::size_t t = 0; t < piece_of.size(); ++t) {
    const std::size_t piece = piece_of[t];
    if (piece == triangles.size()) triangles.emplace_back();
    triangles[piece].push_back(static_cast<int>(t));
  }
  std::vector<geometry::TriangleMesh> pieces;
  for (const std::vector<int>& of_piece : triangles) {
    geometry::TriangleMesh piece = geometry::submesh(mesh, of_piece);
    if (geometry::is_closed(piece)) pieces.push_back(std::move(piece));
  }
  return pieces;
}

bool has_negative_volume(const geometry::TriangleMesh& piece) {
  const auto box = geometry::bounding_box(piece.vertices);
  return geometry::cone_volume(piece.vertices, piece.triangles, piece.vertices.front()) <
         -kNoVolume * std::pow((box[1] - box[0]).norm(), 3);
}

void check_outside(const geometry::TriangleMesh& mesh) {
  geometry::check_mesh(mesh);
  if (mesh.triangles.empty()) throw Refusal(geometry::refusal::kBadMesh, "the shape has no triangles");
  if (geometry::is_closed(mesh) &&
      geometry::cone_volume(mesh.vertices, mesh.triangles, mesh.vertices.front()) <= 0)
    throw Refusal(geometry::refusal::kBadMesh,
                  "the shape is inside out: its triangles must run counter-clockwise from outside");
  const std::vector<geometry::TriangleMesh> pieces = closed_pieces(mesh);
  for (const geometry::TriangleMesh& piece : pieces) {
    if (!has_negative_volume(piece)) continue;
    double turns = 0;
    for (const geometry::TriangleMesh& other : pieces)
      if (&other != &piece) turns += geometry::winding_number(other, piece.vertices.front());
    if (turns < 0.5)
      throw Refusal(geometry::refusal::kBadMesh,
                    "a piece of the shape is inside out, and is no hollow of another one: its triangles must "
                    "run counter-clockwise from outside");
  }
}

// One region a piece. \throw Refusal bad_template: a piece that nothing holds
void add_regions(const geometry::TriangleMesh& mesh, geometry::ControlMesh& control) {
  const std::vector<int> piece_of = geometry::components_of(mesh);
  std::vector<int> held;
  std::vector<char> counted(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < piece_of.size(); ++t) {
    const std::size_t piece = piece_of[t];
    if (piece == control.regions.size()) {
      control.regions.push_back({piece == 0 ? "shape" : "shape_" + std::to_string(piece + 1), {}});
      held.push_back(0);
    }
    control.regions[piece].triangles.push_back(static_cast<int>(t));
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles[t][k];
      if (counted[v] == 0) held[piece] += control.outer_fixed[v];
      counted[v] = 1;
    }
  }
  for (std::size_t piece = 0; piece < held.size(); ++piece)
    if (held[piece] < 3)
      throw Refusal(kBadShape, "piece '" + control.regions[piece].name + "' of the control mesh has " +
                                   std::to_string(held[piece]) + " fixed nodes; three or more hold it");
}

}  // namespace

ShapeFixing load_shape_fixing(const std::string& path) {
  const YAML::Node file = geometry::load_yaml_map(path, kBadShape);
  geometry::check_keys(file, {"nodes", "boxes", "thickness"}, path, kBadShape);
  ShapeFixing fixing;
  fixing.nodes = geometry::optional<std::vector<int>>(file, "nodes", {}, path, kBadShape);
  if (file["thickness"]) fixing.thickness = geometry::number_in(file, "thickness", 1e-6, 10, path, kBadShape);
  if (file["boxes"] && !file["boxes"].IsSequence())
    throw Refusal(kBadShape, path + ": 'boxes' must be a list");
  for (const YAML::Node& box : file["boxes"]) {
    geometry::check_keys(box, {"min", "max"}, path + ": boxes", kBadShape);
    fixing.boxes.push_back({point_at(box, "min", path + ": boxes"), point_at(box, "max", path + ": boxes")});
    if (!(fixing.boxes.back()[0].array() <= fixing.boxes.back()[1].array()).all())
      throw Refusal(kBadShape, path + ": box " + std::to_string(fixing.boxes.size()) +
                                   " holds nothing: its 'min' is beyond its 'max'");
  }
  return fixing;
}

geometry::ControlMesh control_from_shape(const geometry::TriangleMesh& mesh, const ShapeFixing& fixing) {
  check_outside(mesh);
  const std::size_t count = mesh.vertices.size();
  geometry::ControlMesh control;
  control.outer = control.inner = mesh.vertices;
  control.triangles = mesh.triangles;
  control.names.resize(count);
  control.outer_fixed.assign(count, 0);
  for (int node : fixing.nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      throw Refusal(kBadShape, "fixed node " + std::to_string(node) + " is not in the control mesh");
    control.outer_fixed[node] = 1;
  }
  for (std::size_t v = 0; v < count; ++v)
    for (const auto& box : fixing.boxes) {
      const Eigen::Array3d p = mesh.vertices[v].array();
      if ((p >= box[0].array()).all() && (p <= box[1].array()).all()) control.outer_fixed[v] = 1;
    }
  control.inner_fixed = control.outer_fixed;
  add_regions(mesh, control);
  geometry::check_control_mesh(control);
  const double thickness = fixing.thickness > 0 ? fixing.thickness : kShapeThickness * mean_edge(mesh);
  if (!place_inner_nodes(control, std::vector<double>(count, thickness), Skin(mesh)))
    throw Refusal(kBadShape,
                  "inner nodes cross each other below triangles of the control mesh that are narrow for its "
                  "'thickness': make it less, or those triangles wider");
  return control;
}

geometry::ControlMesh simplified_control(const geometry::TriangleMesh& shape, const ShapeFixing& fixing,
                                         int triangles) {
  if (!fixing.nodes.empty())
    throw Refusal(kBadShape,
                  "'nodes' number the vertices of a given control mesh: use 'boxes' where it is made by "
                  "simplification");
  check_outside(shape);
  std::vector<int> all(shape.triangles.size());
  std::iota(all.begin(), all.end(), 0);  // vertices without a triangle are none of the control mesh's
  return control_from_shape(geometry::with_triangles(geometry::submesh(shape, all), triangles), fixing);
}

}  // namespace tensegric_fit::control_mesh
