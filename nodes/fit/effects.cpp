#include "fit/effects.hpp"

#include <algorithm>

#include "geometry/moved_skin.hpp"

namespace tensegric_fit::fit {
namespace {

// Where a point of the skin went, in the body frame.
Eigen::Vector3d carried(const Eigen::Vector3d& point, const Body& body, const Fit& fit) {
  return body.measures.body_from_scan * geometry::carried(point, {body.mesh.mesh, fit.deformed});
}

}  // namespace

std::vector<Effect> effects_of(const Body& body, const Fit& fit) {
  const auto& landmarks = body.measures.landmarks;
  const auto find = [&landmarks](const std::string& name) {
    return std::find_if(landmarks.begin(), landmarks.end(), [&](const auto& l) { return l.name == name; });
  };
  std::vector<Effect> effects;
  for (const std::string name : {"bust_point", "buttock"}) {
    const auto left = find(name + "_L"), right = find(name + "_R");
    if (left == landmarks.end() || right == landmarks.end()) continue;
    const Eigen::Vector3d left_before = body.measures.body_from_scan * left->position,
                          right_before = body.measures.body_from_scan * right->position,
                          left_after = carried(left->position, body, fit),
                          right_after = carried(right->position, body, fit);
    effects.push_back(
        {name + "_height", (left_before.z() + right_before.z()) / 2, (left_after.z() + right_after.z()) / 2});
    effects.push_back(
        {name + "_spread", (left_before - right_before).norm(), (left_after - right_after).norm()});
  }
  return effects;
}

}  // namespace tensegric_fit::fit
