#include "tensegric/band_pressure.hpp"

#include <algorithm>

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// From the skin to the bone below a point, by the nodes that carry it; zero where none does.
Vector3d inward(const Model& model, const geometry::CarriedPoint& point, const Positions& x) {
  const int count = static_cast<int>(model.control.outer.size());
  Vector3d sum = Vector3d::Zero();
  for (const auto& [node, weight] : point.weights)
    if (node < count) sum += std::abs(weight) * (x[node + count] - x[node]);
  return sum.norm() > 0 ? sum.normalized() : sum;
}

}  // namespace

double largest_pressure(const Model& model, const Band& band, const Positions& x, double newtons) {
  if (band.width == 0) return 0;
  double curvature = 0;  // 1/m, the largest
  for (const Thread& thread : band.threads) {
    const std::vector<Vector3d> at = points_of(thread, x);
    for (std::size_t i = 1; i + 1 < at.size(); ++i) {
      const Vector3d before = at[i] - at[i - 1], after = at[i + 1] - at[i];
      const double span = (before.norm() + after.norm()) / 2;
      if (before.norm() == 0 || after.norm() == 0) continue;
      const Vector3d bend = (after.normalized() - before.normalized()) / span;
      curvature = std::max(curvature, bend.dot(inward(model, thread.points[i], x)));
    }
  }
  return newtons / band.width * curvature;
}

}  // namespace tensegric_fit::tensegric
