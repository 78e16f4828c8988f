#include "tensegric/band_length.hpp"

#include <algorithm>

#include "geometry/section.hpp"

namespace tensegric_fit::tensegric {
namespace {

// f(l) = l from `smooth` on, below it an even polynomial that meets it with two equal derivatives.
struct SegmentLength {
  double value, slope_over_length, curvature;
};

SegmentLength segment_length(double l, double smooth) {
  if (l >= smooth) return {l, 1 / l, 0};
  const double t = l / smooth;
  return {smooth * (0.375 + 0.75 * t * t - 0.125 * t * t * t * t), (1.5 - 0.5 * t * t) / smooth,
          (1.5 - 1.5 * t * t) / smooth};
}

// Calls do_with(thread, number of the segment, its span) for each segment.
template <class Do>
void each_span(const Band& band, const Positions& x, const Do& do_with) {
  for (const Thread& thread : band.threads) {
    const std::vector<Eigen::Vector3d> at = points_of(thread, x);
    for (std::size_t i = 1; i < at.size(); ++i) do_with(thread, i - 1, Eigen::Vector3d(at[i] - at[i - 1]));
  }
}

}  // namespace

double length_of(const Band& band, const Positions& x) {
  double length = 0;
  for (const Thread& thread : band.threads)
    length += thread.share * geometry::length_of(points_of(thread, x), false);
  return length;
}

double smooth_length(const Band& band, const Positions& x) {
  double length = 0;
  each_span(band, x, [&](const Thread& thread, std::size_t, const Eigen::Vector3d& span) {
    length += thread.share * segment_length(span.norm(), band.smooth).value;
  });
  return length;
}

double smooth_slope(const Band& band, const Positions& x) {
  double change = 0, length = 0;
  each_span(band, x, [&](const Thread& thread, std::size_t, const Eigen::Vector3d& span) {
    const double segment = span.norm();
    change += thread.share * segment_length(segment, band.smooth).slope_over_length * segment * segment;
    length += thread.share * segment;
  });
  return length > 0 ? change / length : 0;
}

double add_length_gradient(const Band& band, const Positions& x, const std::vector<int>& free_index,
                           double scale, Eigen::Ref<Eigen::VectorXd> gradient) {
  double length = 0;
  each_span(band, x, [&](const Thread& thread, std::size_t i, const Eigen::Vector3d& span) {
    const SegmentLength f = segment_length(span.norm(), band.smooth);
    length += thread.share * f.value;
    const Eigen::Vector3d pull = scale * thread.share * f.slope_over_length * span;
    for (const auto& [node, weight] : thread.spans[i])
      if (free_index[node] >= 0) gradient.segment<3>(3 * free_index[node]) += weight * pull;
  });
  return length;
}

LengthCurvature::LengthCurvature(const Band& band, const std::vector<int>& free_index) : band_(band) {
  std::vector<int> place(free_index.size(), -1);
  for (const Thread& thread : band.threads)
    for (const auto& span : thread.spans)
      for (const auto& [node, weight] : span)
        if (free_index[node] >= 0 && place[node] < 0) {
          place[node] = static_cast<int>(nodes_.size());
          nodes_.push_back(free_index[node]);
        }
  const int nodes = static_cast<int>(nodes_.size());
  std::vector<int> first(nodes);  // that it meets
  for (int p = 0; p < nodes; ++p) first[p] = p;
  for (const Thread& thread : band.threads)
    for (const auto& span : thread.spans) {
      spans_.emplace_back();
      for (const auto& [node, weight] : span)
        if (place[node] >= 0) spans_.back().emplace_back(place[node], weight);
      std::sort(spans_.back().begin(), spans_.back().end());
      for (const auto& [p, by_p] : spans_.back()) first[p] = std::min(first[p], spans_.back().front().first);
    }
  for (int p = 0; p < nodes; ++p) {
    row_.push_back(pairs_ - first[p]);
    pairs_ += p - first[p] + 1;
  }
  std::vector<char> meet(pairs_, 0);
  for (const auto& parts : spans_)
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (std::size_t q = 0; q <= p; ++q) meet[pair_of(parts[p].first, parts[q].first)] = 1;
  for (int p = 0; p < nodes; ++p)
    for (int q = first[p]; q <= p; ++q)
      if (meet[pair_of(p, q)]) coupled_.emplace_back(p, q);
}

std::vector<std::pair<int, int>> LengthCurvature::coupled_nodes() const {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [p, q] : coupled_)
    if (p != q) pairs.emplace_back(nodes_[p], nodes_[q]);
  return pairs;
}

// Each pair's sum first, of a symmetric block's six entries: the matrix is looked into once a pair, not once
// a pair and segment.
void LengthCurvature::add(const Positions& x, double scale, NodeMatrix& hessian) const {
  using Six = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, Eigen::Dynamic> sums = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, pairs_);
  std::size_t next = 0;
  each_span(band_, x, [&](const Thread& thread, std::size_t, const Eigen::Vector3d& span) {
    const double length = span.norm(), whole = scale * thread.share;
    const SegmentLength f = segment_length(length, band_.smooth);
    const Eigen::Vector3d u = length > 0 ? Eigen::Vector3d(span / length) : Eigen::Vector3d::Zero();
    const Eigen::Vector3d v = whole * (f.curvature - f.slope_over_length) * u;
    const double turn = whole * f.slope_over_length;
    Six block;
    block << v.x() * u.x() + turn, v.y() * u.x(), v.z() * u.x(), v.y() * u.y() + turn, v.z() * u.y(),
        v.z() * u.z() + turn;
    const auto& parts = spans_[next++];
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Six row = parts[p].second * block;
      const Eigen::Index start = pair_of(parts[p].first, 0);
      for (std::size_t q = 0; q <= p; ++q) sums.col(start + parts[q].first) += parts[q].second * row;
    }
  });
  for (const auto& [p, q] : coupled_) {
    const auto s = sums.col(pair_of(p, q));
    Eigen::Matrix3d block;
    block << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    hessian.add(nodes_[p], nodes_[q], block);
  }
}

}  // namespace tensegric_fit::tensegric
