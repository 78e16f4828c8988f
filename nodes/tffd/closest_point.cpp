#include "tffd/closest_point.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace tensegric_fit::tffd {

Eigen::Vector3d closest_barycentric(const Eigen::Vector3d& q, const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  Eigen::Vector3d inside;
  for (int k = 0; k < 3; ++k)
    inside[k] = n.dot((corners[(k + 2) % 3] - corners[(k + 1) % 3]).cross(q - corners[(k + 1) % 3]));
  if (inside.minCoeff() >= 0) return inside / inside.sum();

  // Outside the prism over the triangle: the closest point lies on an edge; one of the three, so try each
  // that q is beyond.
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double best_distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (inside[k] >= 0) continue;
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const Eigen::Vector3d along = corners[b] - corners[a];
    const double t = std::clamp(along.dot(q - corners[a]) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (q - corners[a] - t * along).squaredNorm();
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = Eigen::Vector3d::Zero();
    best[a] = 1 - t;
    best[b] = t;
  }
  return best;
}

}  // namespace tensegric_fit::tffd
