#include "metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "surface_distance.hpp"
#include "tffd/binding.hpp"
#include "tffd/body_volume.hpp"

namespace tensegric_fit::regression {
namespace {

using gauge::distances;
using gauge::normal_angles;
using gauge::quantile;

double largest_move(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double largest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) largest = worse(largest, (to.at(i) - from[i]).norm());
  return largest;
}

void add_measures(const Recording& recording, Metrics& metrics) {
  if (!recording.landmarks) return;
  for (const Measure& height : recording.landmarks->heights) metrics["height/" + height.name] = height.value;
  for (const Measure& girth : recording.landmarks->girths) metrics["girth/" + girth.name] = girth.value;
  for (const Landmark& landmark : recording.landmarks->points)
    for (int axis = 0; axis < 3; ++axis)
      metrics["landmark/" + landmark.name + "/" + "xyz"[axis]] = landmark.position[axis];
}

void add_body(const TriangleMesh& body, Metrics& metrics) {
  const geometry::TriangleMesh mesh = node::mesh_in(body);
  metrics["body/triangles"] = static_cast<double>(mesh.triangles.size());
  metrics["body/volume"] = geometry::cone_volume(mesh.vertices, mesh.triangles);
  metrics["body/filled"] = static_cast<double>(std::count(body.filled.begin(), body.filled.end(), 1)) /
                           static_cast<double>(body.filled.size());
}

void add_fit(const FitState& fit, const std::string& prefix, Metrics& metrics) {
  metrics[prefix + "fit/status"] = fit.status;
  metrics[prefix + "fit/solver"] = fit.solver;
  metrics[prefix + "fit/iterations"] = static_cast<double>(fit.iteration);
  metrics[prefix + "fit/residual"] = fit.residual;
  for (const LineResult& line : fit.lines) {
    metrics[prefix + "line/" + line.name + "/ratio"] = line.ratio;
    metrics[prefix + "line/" + line.name + "/tension"] = line.tension;
  }
  for (const RegionResult& region : fit.regions) {
    metrics[prefix + "region/" + region.name + "/volume"] = region.volume_before;
    metrics[prefix + "region/" + region.name + "/volume_error"] =
        region.volume_after / region.volume_before - 1;
  }
}

void add_deformed(const DeformedMesh& deformed, const TriangleMesh& body, const std::string& prefix,
                  Metrics& metrics) {
  metrics[prefix + "body/volume_change"] = deformed.volume_after / deformed.volume_before - 1;
  metrics[prefix + "body/largest_move"] =
      largest_move(node::points_in(body.vertices), node::points_in(deformed.vertices));
  // of the skin that the garment reaches: the rest has exactly 1
  std::vector<double> moved;
  for (const float value : deformed.distortion)
    if (value != 1) moved.push_back(value);
  if (moved.empty()) moved.push_back(1);
  for (const auto& [name, share] :
       {std::pair("least", 0.0), {"p05", 0.05}, {"median", 0.5}, {"p95", 0.95}, {"most", 1.0}})
    metrics[prefix + "distortion/" + name] = quantile(moved, share);
}

// The body as t-FFD carries it, in the posture of the scan.
struct Bound {
  geometry::TriangleMesh body;
  geometry::ControlMesh control;
  tffd::Binding binding;
};

Bound bound_in(const Recording& recording) {
  geometry::TriangleMesh body = node::mesh_in(*recording.body);
  geometry::ControlMesh control = node::control_in(*recording.control);
  tffd::Binding binding(body, control, {});
  return {std::move(body), std::move(control), std::move(binding)};
}

void add_body_volumes(const FitState& fit, const Landmarks& landmarks, const Bound& bound,
                      const std::string& prefix, Metrics& metrics) {
  const geometry::BoneFrames bones = node::bones_of(fit, node::measures_in(landmarks));
  std::vector<Eigen::Vector3d> nodes = node::points_in(fit.outer);
  for (const Eigen::Vector3d& inner : node::points_in(fit.inner)) nodes.push_back(inner);
  const auto carried = tffd::carried_triangles(bound.binding, bound.body.triangles, bound.control);
  for (std::size_t r = 0; r < carried.size(); ++r) {
    if (carried[r].empty()) continue;
    const geometry::ControlRegion& region = bound.control.regions[r];
    const tffd::BodyVolume volume(bound.binding, carried[r], geometry::region_apex(bound.control, region));
    metrics[prefix + "region/" + region.name + "/body_volume_error"] =
        volume.posed(bones, 1)(nodes, nullptr) / volume.at_rest() - 1;
  }
}

// Coordinates of the worn body that are not the nearest single ones to what the weights give in double
// precision. Corners of needles that were put back are off by more, and are left out.
double other_roundings(const FitState& fit, const DeformedMesh& deformed, const Bound& bound) {
  constexpr double kPutBack = 1e-5;  // m
  const auto& [body, control, binding] = bound;
  Eigen::MatrixX3d motion(2 * control.outer.size(), 3);
  const auto outer = node::points_in(fit.outer), inner = node::points_in(fit.inner);
  for (std::size_t i = 0; i < control.outer.size(); ++i) {
    motion.row(i) = (outer[i] - control.outer[i]).transpose();
    motion.row(control.outer.size() + i) = (inner[i] - control.inner[i]).transpose();
  }
  const Eigen::MatrixX3d moved = binding.weights().nodes * motion;
  int others = 0;
  for (const tffd::Anchor& anchor : binding.anchors())
    for (int axis = 0; axis < 3; ++axis) {
      const double exact = body.vertices[anchor.vertex][axis] + moved(anchor.vertex, axis);
      const float found = deformed.vertices[3 * anchor.vertex + axis];
      others += found != static_cast<float>(exact) && std::abs(found - exact) < kPutBack;
    }
  return others;
}

template <typename Measures>
void add_errors(const std::string& kind, const Measures& measured,
                const std::vector<geometry::Measure>& truth, Metrics& errors) {
  for (const Measure& measure : measured)
    for (const geometry::Measure& known : truth)
      if (known.name == measure.name) errors["error/" + kind + known.name] = measure.value - known.metres;
}

// Along a direction that the landmark's definition leaves open any place is right.
double distance(const Eigen::Vector3d& found, const geometry::Landmark& truth,
                const virtual_body::Doubts& doubts) {
  Eigen::Vector3d off = found - truth.position;
  for (const auto& [landmark, direction] : doubts.loose)
    if (landmark == truth.name) off -= off.dot(direction.normalized()) * direction.normalized();
  return off.norm();
}

/// `filled`, and head, hands and feet, whose details are as small as the mesh's triangles.
std::vector<char> detailed(const BodyModel& model, std::vector<char> filled) {
  for (std::size_t v = 0; v < filled.size() && v < model.mesh_parts.size(); ++v) {
    if (model.mesh_parts[v] >= model.parts.size()) continue;
    const std::string part = model.parts[model.mesh_parts[v]].substr(0, 4);
    if (part == "head" || part == "hand" || part == "foot") filled[v] = 1;
  }
  return filled;
}

void add_normals(const std::string& name, const std::vector<double>& angles, Metrics& errors) {
  errors[name + "median"] = quantile(angles, 0.5);
  errors[name + "p95"] = quantile(angles, 0.95);
}

}  // namespace

double worse(double so_far, double next) {
  return std::isfinite(next) ? std::max(so_far, next) : std::numeric_limits<double>::infinity();
}

Metrics metrics_of(const Recording& recording) {
  Metrics metrics;
  metrics["refusal"] = recording.refusal.empty() ? "none" : recording.refusal;
  metrics["refused_by"] = recording.refused_by.empty() ? "none" : recording.refused_by;
  add_measures(recording, metrics);
  if (recording.body) add_body(*recording.body, metrics);
  const bool several = recording.fits.size() > 1;
  std::optional<Bound> bound;
  if (!recording.deformed.empty()) bound = bound_in(recording);
  for (std::size_t i = 0; i < recording.fits.size(); ++i) {
    const std::string prefix = several ? std::to_string(i + 1) + "/" : "";
    add_fit(*recording.fits[i], prefix, metrics);
    if (i >= recording.deformed.size()) continue;
    add_deformed(*recording.deformed[i], *recording.body, prefix, metrics);
    if (recording.landmarks)
      add_body_volumes(*recording.fits[i], *recording.landmarks, *bound, prefix, metrics);
    metrics[prefix + "body/other_roundings"] =
        other_roundings(*recording.fits[i], *recording.deformed[i], *bound);
  }
  for (const auto& [stage, value] : recording.milliseconds) metrics["time/" + stage] = value;
  for (const auto& [stage, value] : recording.peak_mebibytes) metrics["memory/" + stage] = value;
  return metrics;
}

Metrics errors_of(const Recording& recording, const Customer& customer) {
  Metrics errors;
  if (!recording.body) return errors;
  const geometry::TriangleMesh body = node::mesh_in(*recording.body);
  const geometry::TriangleMesh& skin = customer.body.mesh;
  errors["error/body/volume"] = geometry::cone_volume(body.vertices, body.triangles) /
                                    geometry::cone_volume(skin.vertices, skin.triangles) -
                                1;
  const std::vector<double> off = distances(body.vertices, node::filled_in(*recording.body), skin);
  errors["error/surface/median"] = quantile(off, 0.5);
  errors["error/surface/p95"] = quantile(off, 0.95);
  const std::vector<char> filled = node::filled_in(*recording.body);
  add_normals("error/normals/", normal_angles(body, filled, skin), errors);
  if (recording.model)
    add_normals("error/normals/body/", normal_angles(body, detailed(*recording.model, filled), skin), errors);
  errors["noise/median"] = quantile(distances(customer.scan.points, {}, body), 0.5);
  if (!recording.landmarks) return errors;

  const geometry::BodyMeasures& truth = customer.body.truth;
  add_errors("height/", recording.landmarks->heights, truth.heights, errors);
  add_errors("girth/", recording.landmarks->girths, truth.girths, errors);
  for (const Landmark& landmark : recording.landmarks->points)
    if (const geometry::Landmark* known = truth.find_landmark(landmark.name))
      errors["error/landmark/" + landmark.name] =
          distance(Eigen::Vector3d::Map(landmark.position.data()), *known, customer.body.doubts);
  return errors;
}

}  // namespace tensegric_fit::regression
