#include "body_model/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "geometry/parallel_for.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

/// i-th number of the Van der Corput sequence in `base`, in [0, 1).
double radical_inverse(unsigned i, unsigned base) {
  double result = 0, digit = 1.0 / base;
  for (; i > 0; i /= base, digit /= base) result += digit * (i % base);
  return result;
}

/// The samples from number `begin` to `end` over a mesh whose triangles up to each have that area.
void add_samples(const geometry::TriangleMesh& mesh, const std::vector<Vector3d>& normals,
                 const std::vector<char>& filled, const std::vector<double>& area_up_to, unsigned begin,
                 unsigned end, Samples& samples) {
  for (unsigned i = begin; i < end; ++i) {
    const double at =
        area_up_to.back() * radical_inverse(i, 5);  // any first n of them are spread over the whole
    const auto found = std::lower_bound(area_up_to.begin(), area_up_to.end(), at);
    const Eigen::Vector3i& t =
        mesh.triangles[std::min<std::size_t>(found - area_up_to.begin(), mesh.triangles.size() - 1)];
    const double s = std::sqrt(radical_inverse(i, 2)), r = radical_inverse(i, 3);
    const Vector3d share(1 - s, s * (1 - r), s * r);
    Eigen::Index nearest;
    share.maxCoeff(&nearest);
    if (!filled.empty() && filled[t[static_cast<int>(nearest)]]) continue;
    Vector3d point = Vector3d::Zero(), normal = Vector3d::Zero();
    for (int c = 0; c < 3; ++c) {
      point += share[c] * mesh.vertices[t[c]];
      normal += share[c] * normals[t[c]];
    }
    if (normal.squaredNorm() < 1e-12) continue;  // two sheets that face each other
    samples.points.push_back(point);
    samples.normals.push_back(normal.normalized());
  }
}

}  // namespace

Samples shuffled(const Samples& samples) {
  std::vector<std::size_t> order(samples.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(1);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random() % i]);  // std::shuffle differs between libraries
  Samples result;
  for (const std::size_t i : order) {
    result.points.push_back(samples.points[i]);
    result.normals.push_back(samples.normals[i]);
  }
  return result;
}

Samples sample_surface(const geometry::TriangleMesh& mesh, const std::vector<char>& filled, int count) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  std::vector<double> area_up_to;
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    sum += geometry::area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).norm();
    area_up_to.push_back(sum);
  }
  std::array<Samples, 2> of_half;
  if (!(sum > 0)) return {};
  geometry::parallel_for(count, [&](std::size_t begin, std::size_t end, int half) {
    add_samples(mesh, normals, filled, area_up_to, static_cast<unsigned>(begin), static_cast<unsigned>(end),
                of_half[half]);
  });
  Samples& samples = of_half[0];
  samples.points.insert(samples.points.end(), of_half[1].points.begin(), of_half[1].points.end());
  samples.normals.insert(samples.normals.end(), of_half[1].normals.begin(), of_half[1].normals.end());
  return std::move(samples);
}

}  // namespace tensegric_fit::body_model
