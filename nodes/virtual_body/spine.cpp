#include "virtual_body/spine.hpp"

#include <cmath>

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

// Of the circle that an arc lies on, in front of the spine where it bends forward.
struct Circle {
  double x, z, radius;
  explicit Circle(const Spine::Arc& arc)
      : x(arc.x + (arc.high - arc.low) / arc.angle), z(arc.low), radius(x - arc.x) {}
};

}  // namespace

Vector3d Spine::straightened(Vector3d p) const {
  for (const Arc& arc : arcs_) {
    if (arc.angle == 0 || p.z() <= arc.low) continue;
    const Circle c(arc);
    const double side = std::copysign(1.0, arc.angle), ahead = side * (c.x - p.x()), above = p.z() - c.z;
    const double turn = std::min(std::atan2(above, ahead), std::abs(arc.angle));
    // Turned back by `turn` about the circle's middle, then put as high as the arc is long
    const double cosine = std::cos(turn), sine = std::sin(turn);
    p.x() = c.x - side * (cosine * ahead + sine * above);
    p.z() = c.z + (cosine * above - sine * ahead) + std::abs(c.radius) * turn;
  }
  return p;
}

Vector3d Spine::bent(Vector3d p) const {
  for (auto arc = arcs_.rbegin(); arc != arcs_.rend(); ++arc) {
    if (arc->angle == 0 || p.z() <= arc->low) continue;
    const Circle c(*arc);
    const double side = std::copysign(1.0, arc->angle), ahead = side * (c.x - p.x());
    const double turn = std::min((p.z() - c.z) / std::abs(c.radius), std::abs(arc->angle));
    const double above = p.z() - c.z - std::abs(c.radius) * turn, cosine = std::cos(turn),
                 sine = std::sin(turn);
    p.x() = c.x - side * (cosine * ahead - sine * above);
    p.z() = c.z + cosine * above + sine * ahead;
  }
  return p;
}

Vector3d Spine::bent_direction(const Vector3d& p, const Vector3d& d) const {
  constexpr double kStep = 1e-5;
  return (bent(p + kStep * d) - bent(p - kStep * d)).normalized();
}

}  // namespace tensegric_fit::virtual_body
