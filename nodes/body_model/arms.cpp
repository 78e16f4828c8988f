#include "body_model/arms.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

constexpr double kFarthestArm = 0.15;  // m; an arm that is farther is elsewhere, however far
// Degrees from the arm at rest, which is lifted by some 45: raised, taken forwards, and bent at the elbow.
constexpr int kEvery = 4;  // n-th fit point is enough to say where an arm is
constexpr double kRaised[] = {-60, -40, -20, 0, 20, 40, 60};
constexpr double kForwards[] = {-20, 0, 20, 40};
constexpr double kBent[] = {-50, 0, 50};

/// Some fit points of an arm, with their normals at rest.
struct Arm {
  std::vector<int> vertices;
  std::vector<Vector3d> normals;
};

Arm arm_of(const Model& model, const Parameters& p, const std::string& side) {
  const PosedModel posed(model, p);
  const std::vector<Vector3d> normals = geometry::vertex_normals(posed.vertices(), model.triangles);
  Arm arm;
  int met = 0;
  for (const int v : model.fit_points) {
    const std::string& part = model.parts[model.part[v]];
    if ((part == "upper_arm" + side || part == "forearm" + side || part == "hand" + side) &&
        met++ % kEvery == 0) {
      arm.vertices.push_back(v);
      arm.normals.push_back(posed.blend(v).transpose() * normals[v]);
    }
  }
  return arm;
}

/// m, of all its points from the samples; counted no further than to `enough`.
double distance(const Model& model, const Matcher& matcher, const Parameters& p, const Arm& arm,
                double enough) {
  const PosedModel posed(model, p);
  double sum = 0;
  for (std::size_t i = 0; i < arm.vertices.size() && sum < enough; ++i) {
    const int v = arm.vertices[i];
    sum += std::min(matcher.distance(posed.vertex(v), (posed.blend(v) * arm.normals[i]).normalized()),
                    kFarthestArm);
  }
  return sum;
}

}  // namespace

Parameters with_arms_placed(const Model& model, const Matcher& matcher, const Parameters& parameters) {
  Parameters best = parameters;
  for (const double sign : {1.0, -1.0}) {
    const std::string side = sign > 0 ? "_L" : "_R";
    const int arm = model.group_named("arm" + side), forearm = model.group_named("forearm" + side);
    const Arm points = arm_of(model, best, side);
    if (arm < 0 || forearm < 0 || points.vertices.empty()) continue;
    double least = distance(model, matcher, best, points, HUGE_VAL);
    Parameters chosen = best;
    for (const double raised : kRaised)
      for (const double forwards : kForwards)
        for (const double bent : kBent) {
          Parameters p = best;
          p.turns[arm] = Vector3d(-forwards, -sign * raised, 0) * kDegree;
          p.turns[forearm] = Vector3d(bent, 0, 0) * kDegree;
          const double d = distance(model, matcher, p, points, least);
          if (d >= least) continue;
          least = d;
          chosen = p;
        }
    best = chosen;
  }
  return best;
}

}  // namespace tensegric_fit::body_model
