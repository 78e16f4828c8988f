#include "tensegric/band.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "tensegric/band_length.hpp"
#include "tensegric/course.hpp"
#include "tensegric/tension_law.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr double kSmooth = 1e-3;       // m
constexpr double kSmoothShare = 0.03;  // of the mean segment at rest, where that is less

// A line over the control mesh's own nodes.
geometry::Fibre over_nodes(const std::vector<int>& nodes, const Positions& rest) {
  geometry::Fibre fibre{1, {}};
  for (const int node : nodes) fibre.points.push_back({rest[node], {{node, 1.0}}});
  return fibre;
}

// Of weights by node. What two points share in full is none of a segment's.
std::vector<std::pair<int, double>> difference(const std::vector<std::pair<int, double>>& to,
                                               const std::vector<std::pair<int, double>>& from) {
  std::vector<std::pair<int, double>> result;
  auto a = to.begin(), b = from.begin();
  while (a != to.end() || b != from.end()) {
    const bool of_a = b == from.end() || (a != to.end() && a->first <= b->first);
    const bool of_b = a == to.end() || (b != from.end() && b->first <= a->first);
    const int node = of_a ? a->first : b->first;
    double weight = 0;
    if (of_a) weight += (a++)->second;
    if (of_b) weight -= (b++)->second;
    if (weight != 0) result.emplace_back(node, weight);
  }
  return result;
}

Thread thread_of(const geometry::Fibre& fibre, const Positions& rest) {
  Thread thread{fibre.share, fibre.points, {}, {}};
  for (const geometry::CarriedPoint& point : fibre.points) {
    Eigen::Vector3d offset = point.rest;
    for (const auto& [node, weight] : point.weights) offset -= weight * rest[node];
    thread.offsets.push_back(offset);
  }
  for (std::size_t i = 1; i < fibre.points.size(); ++i)
    thread.spans.push_back(difference(fibre.points[i].weights, fibre.points[i - 1].weights));
  return thread;
}

const geometry::LaidLine& laid_line(const std::vector<geometry::LaidLine>& laid, const std::string& name) {
  for (const geometry::LaidLine& line : laid)
    if (line.name == name) return line;
  throw Refusal(refusal::kBadGarment, "line '" + name + "' is a band on a body, and was not laid on one");
}

}  // namespace

std::vector<Eigen::Vector3d> points_of(const Thread& thread, const Positions& x) {
  std::vector<Eigen::Vector3d> at;
  at.reserve(thread.offsets.size());
  for (std::size_t i = 0; i < thread.offsets.size(); ++i) {
    Eigen::Vector3d point = thread.offsets[i];
    for (const auto& [node, weight] : thread.points[i].weights) point += weight * x[node];
    at.push_back(point);
  }
  return at;
}

std::vector<Band> lay_bands(const Model& model, const Garment& garment,
                            const std::vector<geometry::LaidLine>& laid) {
  const Positions rest = model.rest_positions();
  std::vector<Band> bands;
  for (const GarmentLine& line : garment.lines) {
    Band band;
    band.name = line.name;
    if (line.points.empty()) band.nodes = nodes_of(model.control, line);
    if (line.on_body())
      for (const geometry::Fibre& fibre : laid_line(laid, line.name).fibres)
        band.threads.push_back(thread_of(fibre, rest));
    else
      band.threads.push_back(thread_of(over_nodes(band.nodes, rest), rest));
    if (!(line.ratio > 0) || !std::isfinite(line.ratio) || !(line.tension_limit >= 0))
      throw Refusal(refusal::kBadGarment,
                    "line '" + line.name + "' has a ratio or tension limit that is not positive");
    band.law = line.law;
    band.width = line.width;
    band.cup = !line.fan.empty();
    band.tension_limit = line.tension_limit;
    band.request = line.ratio;
    band.initial = length_of(band, rest);
    if (!(band.initial > 0)) throw Refusal(refusal::kBadMesh, "line '" + line.name + "' has no length");
    band.neutral = line.ratio * band.initial;
    band.smooth = std::min(
        kSmooth, kSmoothShare * band.initial / static_cast<double>(band.threads.front().spans.size()));
    band.movable = false;
    for (const Thread& thread : band.threads)
      for (const geometry::CarriedPoint& point : thread.points)
        for (const auto& [node, weight] : point.weights) band.movable = band.movable || !model.is_fixed(node);
    band.steep = is_steep(band.law);
    bands.push_back(band);
  }
  return bands;
}

void pose_band(Band& band, const Positions& rest, const geometry::BoneFrames& bones, double share) {
  for (Thread& thread : band.threads)
    for (std::size_t i = 0; i < thread.points.size(); ++i) {
      thread.offsets[i] = bones.moved(thread.points[i].rest, share);
      for (const auto& [node, weight] : thread.points[i].weights)
        thread.offsets[i] -= weight * bones.moved(rest[node], share);
    }
}

double straight_way(const Model& model, const Band& band, const Positions& x) {
  double way = 0;
  for (const Thread& thread : band.threads) {
    const std::vector<Eigen::Vector3d> at = points_of(thread, x);
    int last = -1;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const auto& weights = thread.points[i].weights;
      if (!std::all_of(weights.begin(), weights.end(),
                       [&](const auto& part) { return model.is_fixed(part.first); }))
        continue;
      if (last >= 0) way += thread.share * (at[i] - at[last]).norm();
      last = static_cast<int>(i);
    }
  }
  return way;
}

}  // namespace tensegric_fit::tensegric
