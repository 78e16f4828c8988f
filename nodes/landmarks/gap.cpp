#include "landmarks/gap.hpp"

#include <algorithm>

namespace tensegric_fit::landmarks {
namespace {

Eigen::Vector3d nearest_on(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p) {
  const double along = (p - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-18);
  return a + std::clamp(along, 0.0, 1.0) * (b - a);
}

// Middle of the narrowest place between two outlines; returns how narrow it is.
double gap_between(const Outline& one, const Outline& other, Eigen::Vector3d& middle) {
  double least = 1e9;
  const auto look = [&](const Outline& points, const Outline& line) {
    for (const Eigen::Vector3d& p : points.points) {
      for (std::size_t i = 0; i < line.points.size(); ++i) {
        const Eigen::Vector3d q = nearest_on(line.points[i], line.points[(i + 1) % line.points.size()], p);
        if ((p - q).norm() >= least) continue;
        least = (p - q).norm();
        middle = (p + q) / 2;
      }
    }
  };
  look(one, other);
  look(other, one);
  return least;
}

}  // namespace

double reach(const Outline& outline, Side side) {
  return side == kLeft ? outline.high.y() : -outline.low.y();
}

bool gap_beside(const Outline& trunk, const std::vector<Outline>& outlines, Side side, double widest,
                Eigen::Vector3d& middle) {
  bool found = false;
  for (const Outline& other : outlines) {
    if (kSign[side] * (other.centroid.y() - trunk.centroid.y()) <= 0 || other.area >= trunk.area) continue;
    Eigen::Vector3d here = Eigen::Vector3d::Zero();
    const double gap = gap_between(trunk, other, here);
    if (gap >= widest) continue;
    widest = gap;
    middle = here;
    found = true;
  }
  return found;
}

}  // namespace tensegric_fit::landmarks
