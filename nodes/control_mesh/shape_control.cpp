#include "control_mesh/shape_control.hpp"

#include <numeric>

#include "geometry/checked_yaml.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using geometry::Refusal;
constexpr const char* kCode = geometry::refusal::kBadTemplate;

Eigen::Vector3d point_at(const YAML::Node& map, const char* key, const std::string& where) {
  const auto xyz = geometry::required<std::vector<double>>(map, key, where, kCode);
  if (xyz.size() != 3) throw Refusal(kCode, where + ": '" + key + "' must be three numbers");
  return {xyz[0], xyz[1], xyz[2]};
}

double mean_edge(const geometry::TriangleMesh& mesh) {
  double sum = 0;
  const auto edges = geometry::edges_of(mesh);
  for (const geometry::Edge& e : edges) sum += (mesh.vertices[e.first] - mesh.vertices[e.second]).norm();
  return sum / static_cast<double>(edges.size());
}

}  // namespace

ShapeFixing load_shape_fixing(const std::string& path) {
  const YAML::Node file = geometry::load_yaml_map(path, kCode);
  geometry::check_keys(file, {"nodes", "boxes", "thickness"}, path, kCode);
  ShapeFixing fixing;
  fixing.nodes = geometry::optional<std::vector<int>>(file, "nodes", {}, path, kCode);
  if (file["thickness"]) fixing.thickness = geometry::number_in(file, "thickness", 1e-6, 10, path, kCode);
  if (file["boxes"] && !file["boxes"].IsSequence()) throw Refusal(kCode, path + ": 'boxes' must be a list");
  for (const YAML::Node& box : file["boxes"]) {
    geometry::check_keys(box, {"min", "max"}, path + ": boxes", kCode);
    fixing.boxes.push_back({point_at(box, "min", path + ": boxes"), point_at(box, "max", path + ": boxes")});
  }
  return fixing;
}

geometry::ControlMesh control_from_shape(const geometry::TriangleMesh& mesh, const ShapeFixing& fixing) {
  geometry::check_mesh(mesh);
  if (geometry::is_closed(mesh) && geometry::cone_volume(mesh.vertices, mesh.triangles) <= 0)
    throw Refusal(geometry::refusal::kBadMesh,
                  "the control mesh is inside out: its triangles must run counter-clockwise from outside");
  const std::size_t count = mesh.vertices.size();
  const double thickness = fixing.thickness > 0 ? fixing.thickness : 0.5 * mean_edge(mesh);
  const auto normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);

  geometry::ControlMesh control;
  control.outer = mesh.vertices;
  control.triangles = mesh.triangles;
  control.names.resize(count);
  control.outer_fixed.assign(count, 0);
  for (int node : fixing.nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      throw Refusal(kCode, "fixed node " + std::to_string(node) + " is not in the control mesh");
    control.outer_fixed[node] = 1;
  }
  for (std::size_t v = 0; v < count; ++v) {
    control.inner.push_back(mesh.vertices[v] - thickness * normals[v]);
    for (const auto& box : fixing.boxes) {
      const Eigen::Array3d p = mesh.vertices[v].array();
      if ((p >= box[0].array()).all() && (p <= box[1].array()).all()) control.outer_fixed[v] = 1;
    }
  }
  control.inner_fixed = control.outer_fixed;
  control.regions = {{"shape", std::vector<int>(mesh.triangles.size())}};
  std::iota(control.regions[0].triangles.begin(), control.regions[0].triangles.end(), 0);
  geometry::check_control_mesh(control);
  return control;
}

}  // namespace tensegric_fit::control_mesh
