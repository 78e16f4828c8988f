#include "body_model/standing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "body_model/missing_parts.hpp"
#include "geometry/checked_yaml.hpp"
#include "geometry/points.hpp"
#include "geometry/shipped_files.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::mean_of;

constexpr double kSole = 0.006;  // m over the lowest point of the feet at rest: skin that bears her
// Deviations: of 100 women who stand upright one seems to lean by 2.5 (fit_standing.py). Round that the
// scan's vertical gives way by degrees, so that a rounding error of the scan moves no measure by much.
constexpr double kUpright = 2, kLeaning = 3;
// degrees, as it is divided by; stances vary by hundreds of times that
constexpr double kLeastDeviation = 0.01;
constexpr std::size_t kStray = 9;  // points that may lie below the feet

constexpr double kApart = 3;  // deviations: of a normal variable one value in 370 is beyond

bool has_both(const RegisteredBody& body, const char* part) {
  const auto [left, right] = sides_there(body, part);
  return left && right;
}

/// Of the model's soles, left and right or one, where pose and shape have them.
std::vector<Vector3d> soles_of(const RegisteredBody& body, const std::array<bool, 2>& sides = {true, true}) {
  const Model& model = *body.model;
  double lowest = model.mean.front().z();
  for (const Vector3d& p : model.mean) lowest = std::min(lowest, p.z());
  std::vector<Vector3d> soles;
  for (std::size_t v = 0; v < model.mean.size(); ++v)
    if (model.mean[v].z() < lowest + kSole && sides[model.mean[v].x() > 0 ? 0 : 1])
      soles.push_back(body.posed[v]);
  return soles;
}

// How far from nothing (2 deviations and less) to certain (3 and more) it is that something deviates.
double doubt_at(double deviations) {
  return std::clamp((deviations - kUpright) / (kLeaning - kUpright), 0.0, 1.0);
}

// Of both feet, or of the one that is there; where one is clearly higher than the other she stands on the
// other.
double height_of_soles(const RegisteredBody& body, const std::array<bool, 2>& sides,
                       const Standing& standing) {
  if (!(sides[0] && sides[1])) return body.vertical.dot(mean_of(soles_of(body, sides)));
  const double left = body.vertical.dot(mean_of(soles_of(body, {true, false}))),
               right = body.vertical.dot(mean_of(soles_of(body, {false, true})));
  const double raised = doubt_at(std::abs(left - right) / (2 * standing.ground));
  return (left + right - raised * std::abs(left - right)) / 2;
}

// From the right one to the left one, level.
Vector3d between(const RegisteredBody& body, const std::string& joint) {
  const Vector3d way = body.joint(joint + ".L") - body.joint(joint + ".R");
  return way - body.vertical.dot(way) * body.vertical;
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
  geometry::check_keys(root,
                       {"made", "bodies", "error", "forwards", "legs_forwards", "sideways", "along", "seen",
                        "soles", "without_feet", "without_thighs", "facing"},
                       path, kCode);
  const auto degrees = [&](const char* key, double least) {
    return geometry::number_in(root, key, least, 5, path, kCode) * M_PI / 180;
  };
  const auto metres = [&](const char* key) { return geometry::number_in(root, key, 0, 0.1, path, kCode); };
  return {degrees("forwards", -5),
          degrees("legs_forwards", -5),
          degrees("sideways", kLeastDeviation),
          degrees("along", kLeastDeviation),
          metres("seen"),
          metres("soles"),
          metres("error"),
          metres("without_feet"),
          metres("without_thighs"),
          degrees("facing", kLeastDeviation)};
}

const Standing& shipped_standing() {
  static const Standing standing = load_standing(geometry::shipped_folder("body_model") + "/standing.yaml");
  return standing;
}

Stance stance_of(const RegisteredBody& body) {
  const Vector3d legs =
      (body.joint("upperleg01.L") + body.joint("upperleg01.R") - body.joint("foot.L") - body.joint("foot.R"))
          .normalized();
  const std::vector<Vector3d> soles = soles_of(body);
  const Vector3d up = (legs + normal_of(soles, legs)).normalized();
  return {up, body.left().cross(up).normalized(), legs, mean_of(soles)};
}

Vector3d upright(const RegisteredBody& body, const Standing& standing) {
  if (!has_both(body, "thigh") || !has_both(body, "shank")) return body.vertical;
  const Stance stance = stance_of(body);
  const bool has_soles = has_both(body, "foot");
  const Vector3d shown = has_soles ? stance.up : stance.legs, forward = body.left().cross(shown).normalized();
  const Vector3d up =
      (shown - std::tan(has_soles ? standing.forwards : standing.legs_forwards) * forward).normalized();
  const Vector3d tilt = up - up.dot(body.vertical) * body.vertical, left = shown.cross(forward);
  const double deviations =
      std::hypot(tilt.dot(left) / standing.sideways, tilt.dot(forward) / standing.along);
  double leaning = doubt_at(deviations);
  if (has_soles) {
    // A booth that is not level tilts legs and soles alike. Where they disagree, as with a bent knee or a
    // foot that is raised, neither says what is upright. Their difference deviates by twice what their mean
    // does.
    const Vector3d differ = 2 * (stance.up.dot(stance.legs) * stance.up - stance.legs);
    leaning *=
        1 -
        doubt_at(std::hypot(differ.dot(left) / standing.sideways, differ.dot(forward) / standing.along) / 2);
  }
  return (body.vertical + leaning * (up - body.vertical)).normalized();
}

double turn_of_feet(const RegisteredBody& body) {
  const Vector3d hips = between(body, "upperleg01"), feet = between(body, "foot");
  return std::atan2(body.vertical.dot(hips.cross(feet)), hips.dot(feet));
}

Vector3d across(const RegisteredBody& body, const Standing& standing) {
  Vector3d left = between(body, "upperleg01");
  // One foot ahead of the other turns their line, not her.
  if (has_both(body, "foot"))
    left += (1 - doubt_at(std::abs(turn_of_feet(body)) / standing.facing)) * between(body, "foot");
  return left.normalized();
}

Ground ground_by_soles(const RegisteredBody& body, const Standing& standing) {
  const auto [left, right] = sides_there(body, "thigh");
  const std::array<bool, 2> both{true, true}, feet = lacks_feet(body) ? both : sides_there(body, "foot");
  return {height_of_soles(body, feet, standing) - standing.soles * std::exp(body.parameters.log_scale),
          left || right ? standing.without_feet : standing.without_thighs};
}

Ground settled_ground(const RegisteredBody& body, double by_lowest, double deviation,
                      const Standing& standing) {
  const double soles = ground_by_soles(body, standing).height, apart = std::abs(by_lowest - soles);
  // each of the two deviates by sqrt(2) of what their mean does, their difference by twice that
  const double deviations = apart / (2 * standing.ground);
  const double doubt = std::clamp((deviations - 1) / (kApart - 1), 0.0, 1.0),
               way = std::clamp(deviations - (kApart - 1), 0.0,
                                1.0);  // at the end either may be right: halfway
  return {by_lowest + way / 2 * (soles - by_lowest), std::hypot(deviation, doubt * apart / 2)};
}

double lowest_of_soles(const RegisteredBody& body) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : soles_of(body)) lowest = std::min(lowest, body.vertical.dot(p));
  return lowest;
}

Ground ground_under(const RegisteredBody& body, const std::vector<Vector3d>& points,
                    const Standing& standing) {
  const Ground by_soles = ground_by_soles(body, standing);
  std::vector<double> heights;
  for (const Vector3d& p : points) heights.push_back(body.vertical.dot(p));
  if (heights.size() <= kStray || lacks_feet(body)) return by_soles;
  std::nth_element(heights.begin(), heights.begin() + kStray, heights.end());
  const double by_lowest = heights[kStray] - standing.seen;
  return {(by_soles.height + by_lowest) / 2,
          settled_ground(body, by_lowest, standing.ground, standing).deviation};
}

}  // namespace tensegric_fit::body_model
