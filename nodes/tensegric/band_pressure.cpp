#include "tensegric/band_pressure.hpp"

#include <algorithm>

#include "geometry/section.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// m, of a fibre at rest. Over shorter ways the curvature is that of single triangles of the skin, or of a
// kink on the inside of a turn. Points of a shipped band, which is averaged over 20 mm, are 9 mm apart. No
// other length was tried.
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
// end; and the way from there to point i, at rest and as `at` has it.
struct Apart {
  std::size_t point;
  double at_rest = 0, now = 0;
};
Apart apart(const Thread& thread, const std::vector<Vector3d>& at, std::size_t i, int ahead) {
  Apart found{i};
  const std::size_t end = ahead > 0 ? at.size() - 1 : 0;
  while (found.at_rest < kChord && found.point != end) {
    const std::size_t next = found.point + ahead;
    found.at_rest += (thread.points[next].rest - thread.points[found.point].rest).norm();
    found.now += (at[next] - at[found.point]).norm();
    found.point = next;
  }
  return found;
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
      const Apart back = apart(thread, at, i, -1), ahead = apart(thread, at, i, 1);
      if (std::min(back.at_rest, ahead.at_rest) < kChord / 2) continue;  // too near an end
      const Vector3d before = at[i] - at[back.point], after = at[ahead.point] - at[i];
      if (before.norm() == 0 || after.norm() == 0) continue;
      const Vector3d bend = (after.normalized() - before.normalized()) / ((back.now + ahead.now) / 2);
      const double curvature = bend.dot(inward(model, thread.points[i], x));
      largest = std::max(largest, crowding(band, threads, t, at[i]) * curvature);
    }
  }
  return newtons / band.width * largest;
}

}  // namespace tensegric_fit::tensegric
