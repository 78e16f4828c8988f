#include "control_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body_model/parts.hpp"
#include "control_mesh/fit_template.hpp"
#include "control_mesh/skin.hpp"
#include "geometry/status.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::population {
namespace {

using Eigen::Vector3d;

constexpr double kLeastCorner = 5;      // degrees; t-FFD extrapolates from a sliver by one over its sine
constexpr double kLeastArea = 2;        // % of the median triangle's
constexpr double kMostStretch = 3.001;  // t-FFD's own bound, and rounding

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

/// Whether a unit is turned inside out: one of its triangles faces away from the middle of the other.
bool inside_out(const geometry::ControlMesh& control, const Eigen::Vector3i& t) {
  Vector3d depth = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) depth += control.outer[t[i]] - control.inner[t[i]];
  return area_of(control.outer, t).dot(depth) <= 0 || area_of(control.inner, t).dot(depth) <= 0;
}

/// Outer triangles that face against the skin nearest to them, and units that are turned inside out.
int folded_triangles(const geometry::ControlMesh& control, const geometry::TriangleMesh& body) {
  const control_mesh::Skin skin(body);  // nearest vertices may be those of the other side of a fold
  int folded = 0;
  for (const Eigen::Vector3i& t : control.triangles) {
    const Vector3d outer = area_of(control.outer, t);
    const Vector3d middle = (control.outer[t[0]] + control.outer[t[1]] + control.outer[t[2]]) / 3;
    Vector3d below = skin.normal_near(middle);
    for (int i = 0; i < 3; ++i) below += skin.normal_near((middle + control.outer[t[i]]) / 2);
    folded += outer.dot(below) <= 0 || inside_out(control, t);
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

/// The least corner of any outer triangle, degrees.
double least_corner(const geometry::ControlMesh& control) {
  double least = 180;
  for (const Eigen::Vector3i& t : control.triangles)
    for (int i = 0; i < 3; ++i) {
      const Vector3d u = control.outer[t[(i + 1) % 3]] - control.outer[t[i]],
                     v = control.outer[t[(i + 2) % 3]] - control.outer[t[i]];
      least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / M_PI);
    }
  return least;
}

/// The least outer triangle's area, % of the median one's.
double least_area(const geometry::ControlMesh& control) {
  std::vector<double> areas;
  for (const Eigen::Vector3i& t : control.triangles) areas.push_back(area_of(control.outer, t).norm());
  std::sort(areas.begin(), areas.end());
  return 100 * areas.front() / areas[areas.size() / 2];
}

/// The largest sum of the absolute entries of a row of M.
double largest_row(const geometry::TriangleMesh& body, const geometry::ControlMesh& control) {
  const tffd::Binding binding(body, control, {});
  const tffd::SparseRows& rows = binding.weights().nodes;
  double largest = 0;
  for (Eigen::Index row = 0; row < rows.outerSize(); ++row) {
    double sum = 0;
    for (tffd::SparseRows::InnerIterator entry(rows, row); entry; ++entry) sum += std::abs(entry.value());
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace

std::vector<Figure> control_figures(const control_mesh::Template& pattern, const geometry::TriangleMesh& body,
                                    const geometry::BodyMeasures& measures,
                                    const body_model::RegisteredBody& model) {
  const std::string name = "control " + pattern.name;
  const auto laid = [&](int triangles) {
    control_mesh::Options options;
    options.control_triangles = triangles;
    return control_mesh::fit_template(pattern, body, measures, options, &model);
  };
  try {
    const geometry::ControlMesh control = laid(control_mesh::Options().control_triangles);
    const geometry::ControlMesh fine = laid(1920);  // 10 mm wide triangles stand for the skin
    const Vector3d apex = geometry::region_apex(control, control.regions[0]);
    const double volume = geometry::cone_volume(control.outer, control.triangles, apex) /
                          geometry::cone_volume(fine.outer, fine.triangles, apex);
    std::vector<Figure> figures{
        information(name + " laid", 0, 0),
        information(name + " off skin", 1e3 * off_skin(control, body), 3.001),
        information(name + " volume %", 100 * (volume - 1), 2),
        information(name + " tips", 1e3 * off_landmarks(pattern, control, measures), 2)};
    const geometry::TriangleMesh trunk = trunk_of(body, model);
    const geometry::ControlMesh finer = laid(4 * static_cast<int>(control.triangles.size()));
    for (const geometry::ControlMesh* mesh : {&control, &finer}) {
      const std::string sized = name + " " + std::to_string(mesh->triangles.size());
      figures.push_back(information(sized + " folded", folded_triangles(*mesh, trunk), 0));
      figures.push_back(information(sized + " corner", std::max(0.0, kLeastCorner - least_corner(*mesh)), 0));
      figures.push_back(information(sized + " area %", std::max(0.0, kLeastArea - least_area(*mesh)), 0));
      figures.push_back(information(sized + " row sum", largest_row(body, *mesh), kMostStretch));
    }
    return figures;
  } catch (const geometry::Refusal& refusal) {
    Figure none = information(name + " laid", std::numeric_limits<double>::infinity(), 0);
    none.cause = refusal.code();
    return {none};
  }
}

}  // namespace tensegric_fit::population
