#include "fit/effects.hpp"

#include <algorithm>

#include "geometry/moved_skin.hpp"

namespace tensegric_fit::fit {

std::vector<Effect> effects_of(const Body& body, const Fit& fit) {
  const auto& landmarks = body.measures.landmarks;
  const auto find = [&landmarks](const std::string& name) {
    return std::find_if(landmarks.begin(), landmarks.end(), [&](const auto& l) { return l.name == name; });
  };
  std::vector<Effect> effects;
  for (const std::string name : {"bust_point", "buttock"}) {
    const auto left = find(name + "_L"), right = find(name + "_R");
    if (left == landmarks.end() || right == landmarks.end()) continue;
    const std::vector<Eigen::Vector3d> before{left->position, right->position},
        after = geometry::carried(before, {body.mesh.mesh, fit.deformed});
    const auto height = [&](const std::vector<Eigen::Vector3d>& points) {
      return (body.measures.body_from_scan * ((points[0] + points[1]) / 2)).z();
    };
    const auto spread = [](const std::vector<Eigen::Vector3d>& points) {
      return (points[0] - points[1]).norm();
    };
    effects.push_back({name + "_height", height(before), height(after)});
    effects.push_back({name + "_spread", spread(before), spread(after)});
  }
  return effects;
}

}  // namespace tensegric_fit::fit
