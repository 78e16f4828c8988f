#include "tffd/weights.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::tffd {
namespace {

// Share of the global kernel where it is fully on. Any value above 0 gives the same limit where the local
// kernels end.
constexpr double kGlobal = 0.05;
// It sets in where no triangle is nearer than this part of its reach.
constexpr double kGlobalFrom = 0.5;

double square(double x) {
  return x * x;
}

struct Nearness {
  double z;                     // distance from the triangle in multiples of its reach
  Eigen::Vector3d barycentric;  // of its closest point
};

Nearness nearness(const Eigen::Vector3d& q, const Frame& frame, double beta) {
  const Eigen::Vector3d barycentric = frame.closest(q);
  return {(q - frame.at(barycentric)).norm() / (beta * frame.radius), barycentric};
}

// Of triangles that have no weight at q, only that they are out of reach: z = 1.
void find_near(const Eigen::Vector3d& q, const std::vector<Frame>& frames, double beta,
               std::vector<Nearness>& near) {
  double nearest = 1;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const bool out_of_reach = frames[t].least_distance(q) > beta * frames[t].radius;
    near[t] = out_of_reach ? Nearness{1, Eigen::Vector3d::Zero()} : nearness(q, frames[t], beta);
    nearest = std::min(nearest, near[t].z);
  }
  if (nearest <= kGlobalFrom) return;
  for (std::size_t t = 0; t < frames.size(); ++t) near[t] = nearness(q, frames[t], beta);
}

// A (1-z)^4 (4z+1), and past half the reach of every triangle more and more of a global kernel in A/z^4, so
// that no vertex is left without weights and nothing jumps where the last local weight ends.
void kernels(const std::vector<Frame>& frames, const std::vector<Nearness>& near, std::vector<double>& k) {
  double nearest = near.front().z;
  for (const Nearness& triangle : near) nearest = std::min(nearest, triangle.z);
  const double on = std::clamp((nearest - kGlobalFrom) / (1 - kGlobalFrom), 0.0, 1.0);
  const double global = kGlobal * on * on * (3 - 2 * on);
  double sum = 0;
  for (std::size_t t = 0; t < near.size(); ++t) {
    const double z = near[t].z;
    k[t] = z < 1 ? square(square(1 - z)) * (4 * z + 1) : 0;
    if (global > 0) k[t] += global * square(square(nearest / z));
    k[t] *= frames[t].area;
    sum += k[t];
  }
  for (double& weight : k) weight /= sum;
}

// A row of a sparse matrix that is gathered in any order.
class Row {
 public:
  explicit Row(Eigen::Index columns) : sums_(static_cast<std::size_t>(columns), 0), used_(sums_.size(), 0) {}

  void add(int column, double value) {
    sums_[column] += value;
    used_[column] = 1;
  }

  // Appends the row, times `factor`, and starts a new one.
  void append_to(SparseRows& matrix, Eigen::Index row, double factor) {
    for (std::size_t column = 0; column < sums_.size(); ++column)
      if (used_[column]) matrix.insertBack(row, static_cast<Eigen::Index>(column)) = factor * sums_[column];
    std::fill(sums_.begin(), sums_.end(), 0);
    std::fill(used_.begin(), used_.end(), 0);
  }

 private:
  std::vector<double> sums_;
  std::vector<char> used_;
};

}  // namespace

Weights standard_weights(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                         const std::vector<Frame>& frames, double beta, const std::vector<Anchor>& anchors) {
  const int outer = static_cast<int>(control.outer.size());
  const Eigen::Index vertices = static_cast<Eigen::Index>(body.vertices.size());
  Weights weights{SparseRows(vertices, 2 * outer), SparseRows(vertices, outer)};
  std::vector<Nearness> near(frames.size());
  std::vector<double> k(frames.size());
  Row nodes(2 * outer), values(outer);
  auto anchor = anchors.begin();
  for (Eigen::Index v = 0; v < vertices; ++v) {
    weights.nodes.startVec(v);
    weights.values.startVec(v);
    if (anchor == anchors.end() || anchor->vertex != v) continue;
    const Eigen::Vector3d& q = body.vertices[v];
    find_near(q, frames, beta, near);
    kernels(frames, near, k);
    for (std::size_t t = 0; t < frames.size(); ++t) {
      if (k[t] == 0) continue;
      const Eigen::Vector3d uvw = frames[t].local(q);
      const double corner[] = {1 - uvw[0] - uvw[1], uvw[0], uvw[1]};
      for (int j = 0; j < 3; ++j) {
        const int node = control.triangles[t][j];
        nodes.add(node, k[t] * (corner[j] + uvw[2] / 3));
        nodes.add(outer + node, -k[t] * uvw[2] / 3);
        values.add(node, k[t] * near[t].barycentric[j]);
      }
    }
    nodes.append_to(weights.nodes, v, anchor->share);
    values.append_to(weights.values, v, anchor->share);
    ++anchor;
  }
  weights.nodes.finalize();
  weights.values.finalize();
  return weights;
}

NormalTerms paper_terms(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Frame>& frames,
                        double beta) {
  NormalTerms bound;
  bound.starts.reserve(vertices.size() + 1);
  bound.starts.push_back(0);
  for (const Eigen::Vector3d& q : vertices) {
    double sum = 0;
    const std::size_t first = bound.terms.size();
    for (std::size_t t = 0; t < frames.size(); ++t) {
      const double k = 1 - (q - frames[t].centroid).norm() / (beta * frames[t].radius);
      if (!(k > 0)) continue;
      bound.terms.push_back({static_cast<int>(t), k, frames[t].local(q)});
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
