#include "tffd/weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tffd/closest_point.hpp"

namespace tensegric_fit::tffd {
namespace {

// Share of the global kernel where it is fully on. Any value above 0 gives the same limit where the local
// kernels end.
constexpr double kGlobal = 0.05;

double square(double x) {
  return x * x;
}

// Distance from each triangle in multiples of its reach.
void distances(const Eigen::Vector3d& q, const std::vector<Frame>& frames, double beta,
               std::vector<double>& z) {
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const Frame& frame = frames[t];
    const Eigen::Vector3d b = closest_barycentric(q, frame.corners);
    const Eigen::Vector3d closest =
        b[0] * frame.corners[0] + b[1] * frame.corners[1] + b[2] * frame.corners[2];
    z[t] = (q - closest).norm() / (beta * frame.radius);
  }
}

// A (1-z)^4 (4z+1), and past half the reach of every triangle more and more of the global A/z^4, so that no
// vertex is left without weights and nothing jumps where the last local weight ends.
void kernels(const std::vector<Frame>& frames, const std::vector<double>& z, std::vector<double>& k) {
  const double nearest = *std::min_element(z.begin(), z.end());
  const double on = std::clamp(2 * nearest - 1, 0.0, 1.0);
  const double global = kGlobal * on * on * (3 - 2 * on);
  double sum = 0;
  for (std::size_t t = 0; t < z.size(); ++t) {
    k[t] = z[t] < 1 ? square(square(1 - z[t])) * (4 * z[t] + 1) : 0;
    if (global > 0) k[t] += global / square(square(z[t]));
    k[t] *= frames[t].area;
    sum += k[t];
  }
  for (double& weight : k) weight /= sum;
}

}  // namespace

NodeWeights standard_weights(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                             const std::vector<Frame>& frames, double beta,
                             const std::vector<Anchor>& anchors) {
  const Eigen::Index nodes = static_cast<Eigen::Index>(control.outer.size());
  NodeWeights weights(static_cast<Eigen::Index>(body.vertices.size()), 2 * nodes);
  std::vector<double> z(frames.size()), k(frames.size());
  Eigen::VectorXd row = Eigen::VectorXd::Zero(2 * nodes);
  std::vector<char> used(static_cast<std::size_t>(nodes));
  std::size_t next = 0;
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    weights.startVec(v);
    if (next == anchors.size() || anchors[next].vertex != v) continue;
    const Anchor& anchor = anchors[next++];
    const Eigen::Vector3d& q = body.vertices[v];
    distances(q, frames, beta, z);
    kernels(frames, z, k);
    row.setZero();
    std::fill(used.begin(), used.end(), 0);
    for (std::size_t t = 0; t < frames.size(); ++t) {
      if (k[t] == 0) continue;
      const Eigen::Vector3d uvw = frames[t].local(q);
      const double outer[] = {1 - uvw[0] - uvw[1], uvw[0], uvw[1]};
      for (int j = 0; j < 3; ++j) {
        const int node = control.triangles[t][j];
        used[node] = 1;
        row[node] += k[t] * (outer[j] + uvw[2] / 3);
        row[nodes + node] -= k[t] * uvw[2] / 3;
      }
    }
    for (Eigen::Index column = 0; column < 2 * nodes; ++column)
      if (used[column % nodes]) weights.insertBack(v, column) = anchor.share * row[column];
  }
  weights.finalize();
  return weights;
}

NormalTerms paper_weights(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Frame>& frames,
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

}  // namespace tensegric_fit::tffd
