#include "control_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body_model/parts.hpp"
#include "control_mesh/fit_template.hpp"
#include "control_mesh/skin.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::population {
namespace {

using Eigen::Vector3d;

Vector3d area_of(const std::vector<Vector3d>& nodes, const Eigen::Vector3i& t) {
  return geometry::area_vector(nodes[t[0]], nodes[t[1]], nodes[t[2]]);
}

/// Arms may lie against the trunk: their skin says nothing about a triangle on it.
geometry::TriangleMesh trunk_of(const geometry::TriangleMesh& body, const body_model::RegisteredBody& model) {
  const std::vector<unsigned char> parts = body_model::parts_of(body, model);
  std::vector<char> keep;
  for (const Eigen::Vector3i& t : body.triangles) {
    bool arm = false;
    for (int i = 0; i < 3; ++i) {
      const std::string part =
          parts[t[i]] == body_model::kUnknownPart ? std::string() : model.model->parts[parts[t[i]]];
      arm = arm || part.find("arm") != std::string::npos || part.find("hand") != std::string::npos;
    }
    keep.push_back(!arm);
  }
  return geometry::submesh(body, keep);
}

/// Outer triangles that face against the skin nearest to them, inner ones that face against their outer one.
int folded_triangles(const geometry::ControlMesh& control, const geometry::TriangleMesh& body) {
  const geometry::PointTree tree(body.vertices);
  const std::vector<Vector3d> normals = geometry::vertex_normals(body.vertices, body.triangles);
  int folded = 0;
  for (const Eigen::Vector3i& t : control.triangles) {
    const Vector3d outer = area_of(control.outer, t);
    const Vector3d middle = (control.outer[t[0]] + control.outer[t[1]] + control.outer[t[2]]) / 3;
    Vector3d skin = normals[tree.nearest(middle)];
    for (int i = 0; i < 3; ++i) skin += normals[tree.nearest((middle + control.outer[t[i]]) / 2)];
    folded += outer.dot(skin) <= 0 || outer.dot(area_of(control.inner, t)) <= 0;
  }
  return folded;
}

double off_skin(const geometry::ControlMesh& control, const geometry::TriangleMesh& body) {
  const control_mesh::Skin skin(body);
  double most = 0;
  for (const Vector3d& p : control.outer) most = std::max(most, (skin.nearest(p) - p).norm());
  return most;
}

double off_landmarks(const control_mesh::Template& pattern, const geometry::ControlMesh& control,
                     const geometry::BodyMeasures& measures) {
  double most = 0;
  for (const control_mesh::TemplateNode& node : pattern.nodes) {
    if (node.placing != control_mesh::TemplateNode::Placing::at_landmark) continue;
    const int at = control.node(node.name);
    if (at >= 0) most = std::max(most, (control.outer[at] - measures.landmark(node.landmark)).norm());
  }
  return most;
}

Figure information(const std::string& name, double error, double limit) {
  Figure figure{name, error, limit};
  figure.counts = false;
  return figure;
}

}  // namespace

std::vector<Figure> control_figures(const control_mesh::Template& pattern, const geometry::TriangleMesh& body,
                                    const geometry::BodyMeasures& measures,
                                    const body_model::RegisteredBody& model) {
  const std::string name = "control " + pattern.name;
  try {
    const geometry::ControlMesh control = control_mesh::fit_template(pattern, body, measures, {}, &model);
    control_mesh::Options options;
    options.control_triangles = 1920;  // 10 mm wide triangles stand for the skin
    const geometry::ControlMesh fine = control_mesh::fit_template(pattern, body, measures, options, &model);
    const Vector3d apex = geometry::region_apex(control, control.regions[0]);
    const double volume = geometry::cone_volume(control.outer, control.triangles, apex) /
                          geometry::cone_volume(fine.outer, fine.triangles, apex);
    return {information(name + " laid", 0, 0),
            information(name + " folded",
                        static_cast<double>(folded_triangles(control, trunk_of(body, model))), 0),
            information(name + " off skin", 1e3 * off_skin(control, body), 3.001),
            information(name + " volume %", 100 * (volume - 1), 2),
            information(name + " tips", 1e3 * off_landmarks(pattern, control, measures), 2)};
  } catch (const geometry::Refusal& refusal) {
    Figure none = information(name + " laid", std::numeric_limits<double>::infinity(), 0);
    none.cause = refusal.code();
    return {none};
  }
}

}  // namespace tensegric_fit::population
