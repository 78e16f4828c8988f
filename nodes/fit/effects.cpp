#include "fit/effects.hpp"

#include <algorithm>

#include "geometry/moved_skin.hpp"

namespace tensegric_fit::fit {

std::vector<Effect> effects_of(const Body& body, const Fit& fit) {
  const auto& landmarks = body.measures.landmarks;
  const auto find = [&landmarks](const std::string& name) {
    return std::find_if(landmarks.begin(), landmarks.end(), [&](const auto& l) { return l.name == name; });
  };
  const std::vector<Eigen::Vector3d> skin =
                                         geometry::in_scan_posture(body.mesh.mesh, fit.deformed, fit.bones),
                                     worn = geometry::landmarks_after(body.measures, {body.mesh.mesh, skin});
  std::vector<Effect> effects;
  for (const std::string name : {"bust_point", "buttock"}) {
    const auto left = find(name + "_L"), right = find(name + "_R");
    if (left == landmarks.end() || right == landmarks.end()) continue;
    const Eigen::Vector3d &left_after = worn[left - landmarks.begin()],
                          &right_after = worn[right - landmarks.begin()];
    const auto height = [&body](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return (body.measures.body_from_scan * ((a + b) / 2)).z();
    };
    effects.push_back(
        {name + "_height", height(left->position, right->position), height(left_after, right_after)});
    effects.push_back(
        {name + "_spread", (left->position - right->position).norm(), (left_after - right_after).norm()});
  }
  return effects;
}

}  // namespace tensegric_fit::fit
