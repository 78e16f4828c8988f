#include "body_model/displacement.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <queue>
#include <set>
#include <tuple>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

constexpr double
    kDeviation = 0.010,
    kRange = 0.15;  // m, of the field: what sixty components leave of a woman who is not of their kind
constexpr double kNoise = 0.001;  // m, of a match, samples beside each other taken together
constexpr double kScales[] = {0.03, 0.02, 0.015, 0.012};  // m, of distances
constexpr int kDisplacementSamples = 20000;
constexpr int kShared = 5;  // nodes that a vertex takes its displacement from

/// Nearest node of each vertex along the skin.
std::vector<int> nearest_nodes(const Model& model) {
  const auto around = geometry::neighbours_of(model.mean.size(), model.triangles);
  std::vector<int> node(model.mean.size(), -1);
  using Entry = std::tuple<double, int, int>;  // distance, vertex, node
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (std::size_t i = 0; i < model.fit_points.size(); ++i)
    front.emplace(0.0, model.fit_points[i], static_cast<int>(i));
  while (!front.empty()) {
    const auto [far, v, n] = front.top();
    front.pop();
    if (node[v] >= 0) continue;
    node[v] = n;
    for (const int w : around[v])
      if (node[w] < 0) front.emplace(far + (model.mean[v] - model.mean[w]).norm(), w, n);
  }
  return node;
}

}  // namespace

SkinField::SkinField(const Model& model) {
  const std::vector<int> node = nearest_nodes(model);
  area_.assign(model.fit_points.size(), 0);
  std::set<std::pair<int, int>> pairs;
  for (const Eigen::Vector3i& t : model.triangles) {
    const double area =
        geometry::area_vector(model.mean[t[0]], model.mean[t[1]], model.mean[t[2]]).norm() / 2;
    for (int c = 0; c < 3; ++c) {
      const int a = node[t[c]], b = node[t[(c + 1) % 3]];
      if (a >= 0) area_[a] += area / 3;
      if (a >= 0 && b >= 0 && a != b) pairs.insert(std::minmax(a, b));
    }
  }
  neighbours_.assign(pairs.begin(), pairs.end());
  std::vector<std::vector<int>> around(area_.size());
  for (const auto& [a, b] : neighbours_) {
    around[a].push_back(b);
    around[b].push_back(a);
  }
  shares_.resize(model.mean.size());
  for (std::size_t v = 0; v < model.mean.size(); ++v) {
    if (node[v] < 0) continue;
    std::vector<std::pair<double, int>> near{
        {(model.mean[v] - model.mean[model.fit_points[node[v]]]).norm(), node[v]}};
    for (const int n : around[node[v]])
      near.emplace_back((model.mean[v] - model.mean[model.fit_points[n]]).norm(), n);
    std::sort(near.begin(), near.end());
    near.resize(std::min<std::size_t>(near.size(), kShared));
    double sum = 0;
    for (const auto& [d, n] : near) {
      const double w = 1 / (d * d + 1e-12);  // a node takes its own displacement
      shares_[v].emplace_back(n, w);
      sum += w;
    }
    for (auto& [n, w] : shares_[v]) w /= sum;
  }
}

Eigen::SparseMatrix<double> SkinField::precision(double deviation, double range) const {
  const double kappa = std::sqrt(8.0) / range, tau = 1 / (std::sqrt(4 * M_PI) * kappa * deviation);
  const int n = static_cast<int>(area_.size());
  const double stiffness = 1 / std::sqrt(3.0);  // half the sum of two cotangents of 60 degrees: even nodes
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, kappa * kappa * area_[i]);
  for (const auto& [a, b] : neighbours_) {
    entries.emplace_back(a, b, -stiffness);
    entries.emplace_back(b, a, -stiffness);
    entries.emplace_back(a, a, stiffness);
    entries.emplace_back(b, b, stiffness);
  }
  Eigen::SparseMatrix<double> k(n, n), inverse_area(n, n);
  k.setFromTriplets(entries.begin(), entries.end());
  entries.clear();
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, tau * tau / area_[i]);
  inverse_area.setFromTriplets(entries.begin(), entries.end());
  return k.transpose() * inverse_area * k;
}

Displaced displace(const Model& model, const SkinField& field, const Matcher& matcher,
                   const Parameters& parameters) {
  const PosedModel posed(model, parameters);
  const std::vector<Vector3d> skin = posed.vertices();
  const int n = static_cast<int>(field.nodes());
  const Eigen::SparseMatrix<double> prior = field.precision(kDeviation, kRange);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  solver.analyzePattern(prior);
  std::vector<Vector3d> moved(n, Vector3d::Zero());
  Displaced result{skin, {}};
  for (const double scale : kScales) {
    const std::vector<Vector3d> normals = geometry::vertex_normals(result.vertices, model.triangles);
    ModelSkin at{{}, {}, std::vector<double>(n, 1)};
    for (const int v : model.fit_points) {
      at.points.push_back(result.vertices[v]);
      at.normals.push_back(normals[v]);
    }
    const Matching matching = matcher.match(at, scale, kDisplacementSamples);
    result.distances = matching.distances;
    Eigen::MatrixX3d rhs(n, 3);
    Eigen::SparseMatrix<double> matrix = prior;
    for (int i = 0; i < n; ++i) {
      const double weight = matching.pulls[i].information.trace() / (kNoise * kNoise);
      matrix.coeffRef(i, i) += weight;
      const Vector3d pull = matching.pulls[i].pull / (kNoise * kNoise);
      rhs.row(i) = (weight * moved[i] - pull).transpose();
    }
    solver.factorize(matrix);
    const Eigen::MatrixX3d solution = solver.solve(rhs);
    for (int i = 0; i < n; ++i) moved[i] = solution.row(i);
    const std::vector<Vector3d> offsets = field.spread<Vector3d>(moved, Vector3d::Zero());
    for (std::size_t v = 0; v < skin.size(); ++v) result.vertices[v] = skin[v] + offsets[v];
  }
  return result;
}

}  // namespace tensegric_fit::body_model
