#include "tffd/weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/status.hpp"

namespace tensegric_fit::tffd {
namespace {

// Share of the global kernel where it is fully on. Any value above 0 gives the same limit where the local
// kernels end.
constexpr double kGlobal = 0.05;
// It sets in where no triangle is nearer than this part of its reach.
constexpr double kGlobalFrom = 0.5;
// Tolerance: what a fibre's point loses of triangles out of its reach, a part of its largest weight.
constexpr double kFar = 1e-3;

// Of a vertex over the middle of well shaped triangles the absolute weights sum to 1 + 2 height / thickness,
// of one at the rim to some more; more than this only by extrapolation from slivers.
constexpr double kMostFrameStretch = 3;
constexpr double kOverLeast =
    1.1;  // tolerance: room for more than one triangle to share a vertex; only this was tried
constexpr double kFirstPower = 0.5, kMostPower = 64;
constexpr int kBisections = 30;

double square(double x) {
  return x * x;
}

// A control triangle as a vertex sees it.
struct Near {
  int triangle;
  double z;                     // distance from the triangle in multiples of its reach
  Eigen::Vector3d barycentric;  // of its closest point
  double k = 0;                 // its share of the vertex
  double stretch = 0;           // what it alone would make of the vertex: sum of the absolute weights
};

Near seen_from(const Eigen::Vector3d& q, int triangle, const Frame& frame, double beta) {
  const Eigen::Vector3d barycentric = frame.closest(q);
  return {triangle, (q - frame.at(barycentric)).norm() / (beta * frame.radius), barycentric};
}

// Ascending; past half the reach of every triangle all of them, for the global kernel.
void find_near(const Eigen::Vector3d& q, const std::vector<Frame>& frames, const Kernel& kernel,
               std::vector<Near>& near) {
  near.clear();
  double nearest = 1;
  for (const int t : kernel.grid.near(q)) {
    if (frames[t].farther_than(kernel.beta * frames[t].radius, q)) continue;
    near.push_back(seen_from(q, t, frames[t], kernel.beta));
    nearest = std::min(nearest, near.back().z);
  }
  if (nearest <= kGlobalFrom) return;
  near.clear();
  for (std::size_t t = 0; t < frames.size(); ++t)
    near.push_back(seen_from(q, static_cast<int>(t), frames[t], kernel.beta));
}

void drop_small(std::vector<Near>& near, double truncation) {
  double most = 0;
  for (const Near& triangle : near) most = std::max(most, triangle.k);
  for (Near& triangle : near)
    if (triangle.k < truncation * most) triangle.k = 0;
}

// A (1-z)^4 (4z+1), and past half the reach of every triangle more and more of a global kernel in A/z^4, so
// that no vertex is left without weights and nothing jumps where the last local weight ends.
void weigh(const std::vector<Frame>& frames, double truncation, std::vector<Near>& near) {
  double nearest = near.front().z;
  for (const Near& triangle : near) nearest = std::min(nearest, triangle.z);
  const double on = std::clamp((nearest - kGlobalFrom) / (1 - kGlobalFrom), 0.0, 1.0);
  const double global = kGlobal * on * on * (3 - 2 * on);
  for (Near& triangle : near) {
    const double z = triangle.z;
    triangle.k = z < 1 ? square(square(1 - z)) * (4 * z + 1) : 0;
    if (global > 0) triangle.k += global * square(square(nearest / z));
    triangle.k *= frames[triangle.triangle].area;
  }
  if (truncation > 0) drop_small(near, truncation);
  double sum = 0;
  for (const Near& triangle : near) sum += triangle.k;
  for (Near& triangle : near) triangle.k /= sum;
}

// Of the global kernel all but what is near: else the point hangs on all nodes, and so do the solver's steps.
void drop_far(std::vector<Near>& near) {
  double most = 0, sum = 0;
  for (const Near& triangle : near) most = std::max(most, triangle.k);
  for (Near& triangle : near) {
    if (triangle.z >= 1 && triangle.k < kFar * most) triangle.k = 0;
    sum += triangle.k;
  }
  for (Near& triangle : near) triangle.k /= sum;
}

// What a triangle alone makes of a vertex: its weights of the outer corners, and of the inner ones.
struct Carried {
  double outer[3];
  double inner;  // each
};

Carried carried_by(const Frame& frame, const Eigen::Vector3d& q, const Eigen::Vector3d* foot) {
  // Of a tied vertex here only the height over its foot: an offset, not a point.
  const Eigen::Vector3d uvw = foot ? frame.local_from_offset * (q - *foot) : frame.local(q);
  const double w = uvw[2] / 3;
  return {{(foot ? 0 : 1) - uvw[0] - uvw[1] + w, uvw[0] + w, uvw[1] + w}, -w};
}

// A row of a sparse matrix that is gathered in any order.
class Row {
 public:
  explicit Row(Eigen::Index columns) : sums_(static_cast<std::size_t>(columns), 0), used_(sums_.size(), 0) {}

  void add(int column, double value) {
    if (!used_[column]) columns_.push_back(column);
    sums_[column] += value;
    used_[column] = 1;
  }

  double absolute() const {
    double sum = 0;
    for (const int column : columns_) sum += std::abs(sums_[column]);
    return sum;
  }

  void clear() {
    for (const int column : columns_) sums_[column] = 0, used_[column] = 0;
    columns_.clear();
  }

  std::size_t entries() const { return columns_.size(); }
  std::size_t columns() const { return sums_.size(); }

  // Node and weight, times `factor`, ascending.
  std::vector<std::pair<int, double>> taken(double factor) {
    std::sort(columns_.begin(), columns_.end());
    std::vector<std::pair<int, double>> row;
    for (const int column : columns_) row.emplace_back(column, factor * sums_[column]);
    return row;
  }

  // Appends the row, times `factor`, and starts a new one.
  void append_to(SparseRows& matrix, Eigen::Index row, double factor) {
    std::sort(columns_.begin(), columns_.end());
    for (const int column : columns_) matrix.insertBack(row, column) = factor * sums_[column];
    clear();
  }

 private:
  std::vector<double> sums_;
  std::vector<char> used_;
  std::vector<int> columns_;
};

double least_stretch(const std::vector<Near>& near) {
  double least = std::numeric_limits<double>::infinity();
  for (const Near& triangle : near)
    if (triangle.k > 0) least = std::min(least, triangle.stretch);
  return least;
}

// Multiplies each triangle's share by (least stretch / its stretch)^power: those that extrapolate far count
// less.
void favour_near(const std::vector<Near>& before, double power, std::vector<Near>& near) {
  const double least = least_stretch(before);
  double sum = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    near[i].k = before[i].k > 0 ? before[i].k * std::pow(least / before[i].stretch, power) : 0;
    sum += near[i].k;
  }
  for (Near& triangle : near) triangle.k /= sum;
}

// Where the absolute weights of a vertex sum to more than kMostFrameStretch, by slivers that would carry it
// far beyond themselves: the least power that brings them down to it, so that rows change smoothly over the
// skin and none changes that need not. Where no triangle by itself comes down to it, down to kOverLeast of
// the one that comes lowest: else that one takes all, and beside it another does, and the skin between them
// tears. Any shares keep the mapping affine-exact.
template <typename Absolute>
void limit_stretch(std::vector<Near>& near, const Absolute& absolute) {
  const double most = std::max(kMostFrameStretch, kOverLeast * least_stretch(near));
  if (absolute(near) <= most) return;
  const std::vector<Near> before = near;
  double low = 0, high = kFirstPower;
  favour_near(before, high, near);
  while (absolute(near) > most && high < kMostPower) {
    low = high;
    high *= 2;
    favour_near(before, high, near);
  }
  for (int step = 0; step < kBisections; ++step) {
    const double middle = 0.5 * (low + high);
    favour_near(before, middle, near);
    (absolute(near) > most ? low : high) = middle;
  }
  favour_near(before, high, near);
}

// The row of M of a point, whose triangles are `near`, in `nodes`: outer ones, then inner ones. Bounds their
// shares.
void gather_nodes(const Eigen::Vector3d& q, const Eigen::Vector3d* foot,
                  const std::vector<Eigen::Vector3i>& triangles, const std::vector<Frame>& frames,
                  std::vector<Near>& near, Row& nodes) {
  const int outer = static_cast<int>(nodes.columns() / 2);
  for (Near& triangle : near) {
    const Carried carried = carried_by(frames[triangle.triangle], q, foot);
    triangle.stretch = 3 * std::abs(carried.inner);
    for (const double weight : carried.outer) triangle.stretch += std::abs(weight);
  }
  const auto gather = [&](const std::vector<Near>& shares) {
    nodes.clear();
    for (const Near& triangle : shares) {
      if (triangle.k == 0) continue;
      const Carried carried = carried_by(frames[triangle.triangle], q, foot);
      for (int j = 0; j < 3; ++j) {
        const int node = triangles[triangle.triangle][j];
        nodes.add(node, triangle.k * carried.outer[j]);
        nodes.add(outer + node, triangle.k * carried.inner);
      }
    }
  };
  limit_stretch(near, [&](const std::vector<Near>& shares) {
    gather(shares);
    return nodes.absolute();
  });
  gather(near);
}

Eigen::Vector3d foot_of(const Tie& tie, const std::vector<Eigen::Vector3d>& vertices) {
  return vertices[tie.from] + tie.part * (vertices[tie.to] - vertices[tie.from]);
}

// Adds the motion of the feet to the rows of the tied vertices.
void follow_feet(const std::vector<Tie>& ties, SparseRows& nodes) {
  if (ties.empty()) return;
  std::vector<Eigen::Triplet<double>> parts;
  for (const Tie& tie : ties) {
    parts.emplace_back(tie.vertex, tie.from, 1 - tie.part);
    parts.emplace_back(tie.vertex, tie.to, tie.part);
  }
  SparseRows feet(nodes.rows(), nodes.rows());
  feet.setFromTriplets(parts.begin(), parts.end());
  const SparseRows carried = feet * nodes;
  nodes = SparseRows(nodes + carried);
}

}  // namespace

std::vector<std::pair<int, double>> weights_at(const Eigen::Vector3d& q, double share, std::size_t outer,
                                               const std::vector<Eigen::Vector3i>& triangles,
                                               const std::vector<Frame>& frames, const Kernel& kernel) {
  std::vector<Near> near;
  find_near(q, frames, kernel, near);
  weigh(frames, kernel.truncation, near);
  drop_far(near);
  Row nodes(2 * static_cast<Eigen::Index>(outer));
  gather_nodes(q, nullptr, triangles, frames, near, nodes);
  return nodes.taken(share);
}

Weights standard_weights(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                         const std::vector<Frame>& frames, const Kernel& kernel,
                         const std::vector<Anchor>& anchors, const std::vector<Tie>& ties) {
  const int outer = static_cast<int>(control.outer.size());
  const Eigen::Index vertices = static_cast<Eigen::Index>(body.vertices.size());
  Weights weights{SparseRows(vertices, 2 * outer), SparseRows(vertices, outer)};
  std::vector<const Tie*> tie_of(body.vertices.size(), nullptr);
  for (const Tie& tie : ties) tie_of[tie.vertex] = &tie;
  std::vector<Near> near;
  Row nodes(2 * outer), values(outer);
  std::size_t entries = 0;
  auto anchor = anchors.begin();
  for (Eigen::Index v = 0; v < vertices; ++v) {
    weights.nodes.startVec(v);
    weights.values.startVec(v);
    if (anchor == anchors.end() || anchor->vertex != v) continue;
    const Eigen::Vector3d& q = body.vertices[v];
    const Tie* tie = tie_of[v];
    find_near(q, frames, kernel, near);
    weigh(frames, kernel.truncation, near);
    const Eigen::Vector3d foot = tie ? foot_of(*tie, body.vertices) : q;
    gather_nodes(q, tie ? &foot : nullptr, control.triangles, frames, near, nodes);
    for (const Near& triangle : near)
      for (int j = 0; j < 3 && triangle.k > 0; ++j)
        values.add(control.triangles[triangle.triangle][j], triangle.k * triangle.barycentric[j]);
    entries += nodes.entries();
    if (entries > kernel.most_entries)
      throw geometry::Refusal(geometry::refusal::kBadMesh,
                              "t-FFD: the shape lies too far off its control mesh, or beta is too large: it "
                              "would take more than " +
                                  std::to_string(kernel.most_entries) + " weights");
    nodes.append_to(weights.nodes, v, anchor->share);
    values.append_to(weights.values, v, anchor->share);
    ++anchor;
  }
  weights.nodes.finalize();
  weights.values.finalize();
  follow_feet(ties, weights.nodes);
  return weights;
}

NormalTerms paper_terms(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Frame>& frames,
                        const Kernel& kernel) {
  NormalTerms bound;
  bound.starts.reserve(vertices.size() + 1);
  bound.starts.push_back(0);
  for (const Eigen::Vector3d& q : vertices) {
    double sum = 0;
    const std::size_t first = bound.terms.size();
    for (const int t : kernel.grid.near(q)) {
      const double k = 1 - (q - frames[t].centroid).norm() / (kernel.beta * frames[t].radius);
      if (!(k > 0)) continue;
      bound.terms.push_back({t, k, frames[t].local(q)});
      sum += k;
    }
    for (std::size_t i = first; i < bound.terms.size(); ++i) bound.terms[i].weight /= sum;
    bound.starts.push_back(static_cast<int>(bound.terms.size()));
  }
  return bound;
}

SparseRows paper_values(const std::vector<Eigen::Vector3d>& vertices, const geometry::ControlMesh& control,
                        const std::vector<Frame>& frames, const NormalTerms& bound) {
  SparseRows weights(static_cast<Eigen::Index>(vertices.size()),
                     static_cast<Eigen::Index>(control.outer.size()));
  Row row(weights.cols());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    weights.startVec(static_cast<Eigen::Index>(v));
    for (int i = bound.starts[v]; i < bound.starts[v + 1]; ++i) {
      const NormalTerm& term = bound.terms[i];
      const Eigen::Vector3d b = frames[term.triangle].closest(vertices[v]);
      for (int j = 0; j < 3; ++j) row.add(control.triangles[term.triangle][j], term.weight * b[j]);
    }
    row.append_to(weights, static_cast<Eigen::Index>(v), 1);
  }
  weights.finalize();
  return weights;
}

}  // namespace tensegric_fit::tffd
