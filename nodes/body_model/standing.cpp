#include "body_model/standing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "body_model/recognition.hpp"
#include "geometry/checked_yaml.hpp"
#include "geometry/points.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::mean_of;

constexpr double kSole = 0.006;  // m over the lowest point of the feet at rest: skin that bears her
// Deviations: of 100 women who stand upright 13 seem to lean by 2, one by 3. In between the scan's
// vertical gives way by degrees, so that a rounding error of the scan moves no measure by much.
constexpr double kUpright = 2, kLeaning = 3;
constexpr std::size_t kStray = 9;  // points that may lie below the feet

/// Of the model's soles, where pose and shape have them.
std::vector<Vector3d> soles_of(const RegisteredBody& body) {
  const Model& model = *body.model;
  double lowest = model.mean.front().z();
  for (const Vector3d& p : model.mean) lowest = std::min(lowest, p.z());
  std::vector<Vector3d> soles;
  for (std::size_t v = 0; v < model.mean.size(); ++v)
    if (model.mean[v].z() < lowest + kSole) soles.push_back(body.posed[v]);
  return soles;
}

Vector3d normal_of(const std::vector<Vector3d>& points, const Vector3d& up) {
  const Vector3d mean = mean_of(points);
  Matrix3d squares = Matrix3d::Zero();
  for (const Vector3d& p : points) squares += (p - mean) * (p - mean).transpose();
  const Vector3d normal = Eigen::SelfAdjointEigenSolver<Matrix3d>(squares).eigenvectors().col(0);
  return normal.dot(up) < 0 ? Vector3d(-normal) : normal;
}

}  // namespace

Standing load_standing(const std::string& path) {
  constexpr const char* kCode = geometry::refusal::kBrokenFile;
  const YAML::Node root = geometry::load_yaml_map(path, kCode);
  geometry::check_keys(
      root, {"made", "bodies", "error", "forwards", "sideways", "along", "seen", "soles", "without_feet"},
      path, kCode);
  const auto degrees = [&](const char* key) {
    return geometry::number_in(root, key, -5, 5, path, kCode) * M_PI / 180;
  };
  const auto metres = [&](const char* key) { return geometry::number_in(root, key, 0, 0.02, path, kCode); };
  return {degrees("forwards"), degrees("sideways"), degrees("along"),      metres("seen"),
          metres("soles"),     metres("error"),     metres("without_feet")};
}

Stance stance_of(const RegisteredBody& body) {
  const Vector3d legs =
      (body.joint("upperleg01.L") + body.joint("upperleg01.R") - body.joint("foot.L") - body.joint("foot.R"))
          .normalized();
  const std::vector<Vector3d> soles = soles_of(body);
  const Vector3d up = (legs + normal_of(soles, legs)).normalized();
  return {up, body.left().cross(up).normalized(), mean_of(soles)};
}

Vector3d upright(const RegisteredBody& body, const Standing& standing) {
  const Stance stance = stance_of(body);
  const Vector3d up = (stance.up - std::tan(standing.forwards) * stance.forward).normalized();
  const Vector3d tilt = up - up.dot(body.vertical) * body.vertical, left = stance.up.cross(stance.forward);
  const double deviations =
      std::hypot(tilt.dot(left) / standing.sideways, tilt.dot(stance.forward) / standing.along);
  const double leaning = std::clamp((deviations - kUpright) / (kLeaning - kUpright), 0.0, 1.0);
  return (body.vertical + leaning * (up - body.vertical)).normalized();
}

Ground ground_without_feet(const RegisteredBody& body, const Standing& standing) {
  return {body.vertical.dot(stance_of(body).soles) - standing.soles * std::exp(body.parameters.log_scale),
          standing.without_feet};
}

double lowest_of_soles(const RegisteredBody& body) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : soles_of(body)) lowest = std::min(lowest, body.vertical.dot(p));
  return lowest;
}

Ground ground_under(const RegisteredBody& body, const std::vector<Vector3d>& points,
                    const Standing& standing) {
  const Ground by_soles = ground_without_feet(body, standing);
  std::vector<double> heights;
  for (const Vector3d& p : points) heights.push_back(body.vertical.dot(p));
  if (heights.size() <= kStray || lacks_feet(body)) return by_soles;
  std::nth_element(heights.begin(), heights.begin() + kStray, heights.end());
  return {(by_soles.height + heights[kStray] - standing.seen) / 2, standing.ground};
}

}  // namespace tensegric_fit::body_model
