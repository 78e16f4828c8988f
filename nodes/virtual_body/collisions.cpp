#include <algorithm>
#include <cmath>

#include "geometry/section.hpp"
#include "virtual_body/model_body.hpp"
#include "virtual_body/sagittal.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;
using geometry::SectionLoop;

constexpr double kLevelSpacing = 0.005;  // m between sections

enum class Limb { none, arm_left, arm_right, leg_left, leg_right };

Limb limb_of(const std::string& part) {
  const bool left = part.size() > 2 && part.compare(part.size() - 2, 2, "_L") == 0;
  const auto is = [&](const char* name) { return part.rfind(name, 0) == 0; };
  if (is("upper_arm") || is("forearm") || is("hand")) return left ? Limb::arm_left : Limb::arm_right;
  if (is("thigh") || is("shank") || is("foot")) return left ? Limb::leg_left : Limb::leg_right;
  return Limb::none;
}

/// The limb that most of a loop's triangles belong to.
Limb limb_of(const SectionLoop& loop, const std::vector<Limb>& triangles) {
  int count[5] = {};
  for (const int t : loop.triangles) ++count[static_cast<int>(triangles[t])];
  return static_cast<Limb>(std::max_element(count, count + 5) - count);
}

/// Even-odd rule.
bool is_inside(const Vector3d& p, const std::vector<Vector3d>& loop) {
  bool inside = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    const Vector3d &a = loop[i], &b = loop[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

bool overlap(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  const auto reaches_into = [](const std::vector<Vector3d>& one, const std::vector<Vector3d>& other) {
    return std::any_of(one.begin(), one.end(), [&](const Vector3d& p) { return is_inside(p, other); });
  };
  return reaches_into(a, b) || reaches_into(b, a);
}

}  // namespace

Collisions collisions(const body_model::Model& model, const std::vector<Vector3d>& vertices) {
  std::vector<Limb> of_part, of_triangle;
  for (const std::string& part : model.parts) of_part.push_back(limb_of(part));
  for (const Eigen::Vector3i& t : model.triangles) of_triangle.push_back(of_part[model.part[t[0]]]);
  const geometry::TriangleMesh mesh{vertices, model.triangles};
  const auto box = geometry::bounding_box(vertices);
  Collisions found{{false, false}, false};
  for (double z = box[0].z() + kLevelSpacing; z < box[1].z(); z += kLevelSpacing) {
    const auto loops = geometry::plane_section(mesh, {0, 0, z}, Vector3d::UnitZ());
    std::vector<Limb> limbs;
    for (const SectionLoop& loop : loops) limbs.push_back(limb_of(loop, of_triangle));
    for (std::size_t a = 0; a < loops.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        if (limbs[a] == limbs[b]) continue;
        const auto concerns = [&](Limb limb) { return limbs[a] == limb || limbs[b] == limb; };
        const bool left = concerns(Limb::arm_left), right = concerns(Limb::arm_right),
                   legs = concerns(Limb::leg_left) && concerns(Limb::leg_right);
        if ((!left && !right && !legs) || !overlap(loops[a].points, loops[b].points)) continue;
        found.arms[kLeft] |= left;
        found.arms[kRight] |= right;
        found.legs |= legs;
      }
  }
  return found;
}

}  // namespace tensegric_fit::virtual_body
