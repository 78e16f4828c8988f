#include "tensegric/band_pressure.hpp"

#include <algorithm>

#include "geometry/section.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// m, of a fibre at rest. Over shorter ways the curvature is that of single triangles of the skin, or of a
// kink on the inside of a turn. Points of a shipped band, which is averaged over 20 mm, are farther apart.
constexpr double kChord = 0.0075;

// From the skin to the bone below a point, by the nodes that carry it; zero where none does.
Vector3d inward(const Model& model, const geometry::CarriedPoint& point, const Positions& x) {
  const int count = static_cast<int>(model.control.outer.size());
  Vector3d sum = Vector3d::Zero();
  for (const auto& [node, weight] : point.weights)
    if (node < count) sum += std::abs(weight) * (x[node + count] - x[node]);
  return sum.norm() > 0 ? sum.normalized() : sum;
}

// Pull per width at a point of a thread, as a multiple of that of a band of this width: a cup's threads lie
// closer or farther apart than a band's.
double crowding(const Band& band, const std::vector<std::vector<Vector3d>>& threads, std::size_t t,
                const Vector3d& point) {
  if (!band.cup) return 1;
  double strip = 0;  // half way to the threads beside it
  if (t > 0) strip += geometry::distance_to_line(point, threads[t - 1]) / 2;
  if (t + 1 < threads.size()) strip += geometry::distance_to_line(point, threads[t + 1]) / 2;
  return strip > 0 ? band.threads[t].share * band.width / strip : 0;
}

// The first point of a thread that is kChord of its way at rest from point i, ahead (1) or back (-1), or its
// end.
std::size_t apart(const Thread& thread, std::size_t i, int ahead) {
  const auto last = static_cast<std::ptrdiff_t>(thread.points.size()) - 1;
  auto at = static_cast<std::ptrdiff_t>(i);
  for (double way = 0; way < kChord && (ahead > 0 ? at < last : at > 0); at += ahead)
    way += (thread.points[at + ahead].rest - thread.points[at].rest).norm();
  return static_cast<std::size_t>(at);
}

}  // namespace

double largest_pressure(const Model& model, const Band& band, const Positions& x, double newtons) {
  if (band.width == 0) return 0;
  std::vector<std::vector<Vector3d>> threads;
  for (const Thread& thread : band.threads) threads.push_back(points_of(thread, x));
  double largest = 0;  // 1/m, of curvature times crowding
  for (std::size_t t = 0; t < threads.size(); ++t) {
    const std::vector<Vector3d>& at = threads[t];
    for (std::size_t i = 1; i + 1 < at.size(); ++i) {
      const Thread& thread = band.threads[t];
      const Vector3d before = at[i] - at[apart(thread, i, -1)], after = at[apart(thread, i, 1)] - at[i];
      const double span = (before.norm() + after.norm()) / 2;
      if (std::min(before.norm(), after.norm()) < kChord / 2) continue;  // too near an end
      const Vector3d bend = (after.normalized() - before.normalized()) / span;
      const double curvature = bend.dot(inward(model, band.threads[t].points[i], x));
      largest = std::max(largest, crowding(band, threads, t, at[i]) * curvature);
    }
  }
  return newtons / band.width * largest;
}

}  // namespace tensegric_fit::tensegric
