#include "body_model/matching.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/parallel_for.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFarthest = 2.5;  // scales
constexpr double kAstray = 0.5;   // scales from the sample's own model point: half counts at two thirds of it
constexpr double kSideways = 15;  // 1/m^2: a match a metre off is one of points, a near one of planes

/// What one pair says.
struct Pair {
  double weight;    // 0: nothing
  double distance;  // m, from the sample's plane
};

Pair weigh(const Vector3d& off, const Vector3d& model_normal, const Vector3d& sample_normal, double scale) {
  const double squared = off.squaredNorm() / (scale * scale);
  if (squared > kFarthest * kFarthest || model_normal.dot(sample_normal) < Matching::kSameSide)
    return {0, Matching::kUnmatched};
  const double robust = 1 / (1 + squared);
  return {robust * robust, std::min(std::abs(off.dot(sample_normal)), Matching::kUnmatched)};
}

template <typename Work>
void in_parallel(std::size_t count, const Work& work) {
  if (static_cast<int>(count) < kWorthThreads) return work(0, count);
  geometry::parallel_for(count, [&](std::size_t begin, std::size_t end, int) { work(begin, end); });
}

}  // namespace

Matcher::Matcher(const Samples& samples) : samples_(samples), tree_(samples.points, samples.normals) {}

Matching Matcher::match(const ModelSkin& skin, double scale, int samples) const {
  const std::size_t count = skin.points.size();
  Matching result{std::vector<Pull>(count), std::vector<double>(count), {}};
  const double sideways = kSideways * scale * scale;
  const geometry::OrientedTree model(skin.points, skin.normals);
  in_parallel(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int s = tree_.nearest(skin.points[i], skin.normals[i]);
      const Vector3d off = skin.points[i] - samples_.points[s], &n = samples_.normals[s];
      const Pair pair = weigh(off, skin.normals[i], n, scale);
      result.distances[i] = pair.distance;
      // A part that the samples lack finds those of another part, which belong to that.
      const int owner = pair.weight > 0 ? model.nearest(samples_.points[s], n) : static_cast<int>(i);
      const double astray =
          (skin.points[owner] - skin.points[i]).squaredNorm() / std::pow(kAstray * scale, 2);
      const double w = skin.weights[i] * pair.weight / ((1 + astray) * (1 + astray));
      result.pulls[i].information = w * (n * n.transpose() + sideways * Matrix3d::Identity());
      result.pulls[i].pull = w * (n * n.dot(off) + sideways * off);
    }
  });
  const std::size_t looking = std::min<std::size_t>(samples, samples_.points.size());
  std::vector<int> near(looking), finders(count, 0);
  in_parallel(looking, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      near[s] = model.nearest(samples_.points[s], samples_.normals[s]);
  });
  for (const int i : near) ++finders[i];
  for (std::size_t s = 0; s < looking; ++s) {
    const int i = near[s];
    // The nearest model point may lie half their spacing aside: only what is along the normal counts.
    const Vector3d off = skin.points[i] - samples_.points[s], &n = samples_.normals[s];
    const Pair pair = weigh(off, skin.normals[i], n, scale);
    result.unexplained.push_back(pair.distance);
    const double w = skin.weights[i] * pair.weight / finders[i];
    result.pulls[i].information += w * n * n.transpose();
    result.pulls[i].pull += w * n * n.dot(off);
  }
  return result;
}

}  // namespace tensegric_fit::body_model
