#include "body_model/arms.hpp"

#include <algorithm>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
constexpr double kFarthest = 0.15;  // m; an arm that is farther is elsewhere, however far
// Degrees from the arm at rest, which is lifted by some 45: raised, taken forwards, and bent at the elbow.
constexpr double kRaised[] = {-60, -40, -20, 0, 20, 40, 60};
constexpr double kForwards[] = {-20, 0, 20, 40};
constexpr double kBent[] = {-50, 0, 50};

/// Vertices of a pose group's bones and those beyond.
std::vector<int> arm_points(const Model& model, const std::string& side) {
  std::vector<int> points;
  for (const int v : model.fit_points)
    for (const char* part : {"upper_arm", "forearm", "hand"})
      if (model.parts[model.part[v]] == std::string(part) + side) points.push_back(v);
  return points;
}

double distance(const Model& model, const Matcher& matcher, const Parameters& p, const std::vector<int>& points) {
  const PosedModel posed(model, p);
  double sum = 0;
  const std::vector<Vector3d> normals = geometry::vertex_normals(posed.vertices(), model.triangles);
  for (const int v : points) sum += std::min(matcher.distance(posed.vertex(v), normals[v]), kFarthest);
  return sum;
}

}  // namespace

Parameters with_arms_placed(const Model& model, const Matcher& matcher, const Parameters& parameters) {
  Parameters best = parameters;
  for (const double sign : {1.0, -1.0}) {
    const std::string side = sign > 0 ? "_L" : "_R";
    const int arm = model.group_named("arm" + side), forearm = model.group_named("forearm" + side);
    const std::vector<int> points = arm_points(model, side);
    if (arm < 0 || forearm < 0 || points.empty()) continue;
    double least = distance(model, matcher, best, points);
    Parameters chosen = best;
    for (const double raised : kRaised)
      for (const double forwards : kForwards)
        for (const double bent : kBent) {
          Parameters p = best;
          p.turns[arm] = Vector3d(-forwards, -sign * raised, 0) * kDegree;
          p.turns[forearm] = Vector3d(bent, 0, 0) * kDegree;
          const double d = distance(model, matcher, p, points);
          if (d >= least) continue;
          least = d;
          chosen = p;
        }
    best = chosen;
  }
  return best;
}

}  // namespace tensegric_fit::body_model
