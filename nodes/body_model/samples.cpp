#include "body_model/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>

#include "geometry/order_of_place.hpp"
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

/// The samples from number `begin` to `end` over triangles that up to each have that area.
void add_samples(const geometry::TriangleMesh& mesh, const std::vector<Eigen::Vector3i>& triangles,
                 const std::vector<Vector3d>& normals, const std::vector<char>& filled,
                 const std::vector<double>& area_up_to, unsigned begin, unsigned end, Samples& samples) {
  for (unsigned i = begin; i < end; ++i) {
    const double at =
        area_up_to.back() * radical_inverse(i, 5);  // any first n of them are spread over the whole
    const auto found = std::lower_bound(area_up_to.begin(), area_up_to.end(), at);
    const Eigen::Vector3i& t =
        triangles[std::min<std::size_t>(found - area_up_to.begin(), triangles.size() - 1)];
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

/// Neighbouring numbers to numbers that have nothing to do with each other (SplitMix64; Steele, Lea and Flood
/// 2014).
std::uint64_t mixed(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9;
  number = (number ^ (number >> 27)) * 0x94d049bb133111eb;
  return number ^ (number >> 31);
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

Samples shuffled_by_place(const Samples& samples) {
  constexpr double kCube = 0.007;  // m: as far as samples are apart; the fewer change cubes, the better
  using Place = std::array<std::int64_t, 4>;  // a sample's cube, and its number
  std::vector<Place> places;
  for (const Vector3d& p : samples.points)
    places.push_back({std::llround(p.x() / kCube), std::llround(p.y() / kCube), std::llround(p.z() / kCube),
                      static_cast<std::int64_t>(places.size())});
  std::sort(places.begin(), places.end());
  std::vector<std::pair<std::uint64_t, std::int64_t>> order;
  std::uint64_t in_cube = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    in_cube = i > 0 && std::equal(places[i].begin(), places[i].begin() + 3, places[i - 1].begin())
                  ? in_cube + 1
                  : 0;
    std::uint64_t key = in_cube;
    for (int axis = 0; axis < 3; ++axis) key = mixed(key ^ static_cast<std::uint64_t>(places[i][axis]));
    order.emplace_back(key, places[i][3]);
  }
  std::sort(order.begin(), order.end());
  Samples result;
  for (const auto& [key, i] : order) {
    result.points.push_back(samples.points[i]);
    result.normals.push_back(samples.normals[i]);
  }
  return result;
}

Samples sample_surface(const geometry::TriangleMesh& mesh, const std::vector<char>& filled, int count) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  const std::vector<Eigen::Vector3i> triangles = geometry::in_order_of_place(mesh);
  std::vector<double> area_up_to;
  double sum = 0;
  for (const Eigen::Vector3i& t : triangles) {
    sum += geometry::area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).norm();
    area_up_to.push_back(sum);
  }
  std::array<Samples, 2> of_half;
  if (!(sum > 0)) return {};
  geometry::parallel_for(count, [&](std::size_t begin, std::size_t end, int half) {
    add_samples(mesh, triangles, normals, filled, area_up_to, static_cast<unsigned>(begin),
                static_cast<unsigned>(end), of_half[half]);
  });
  Samples& samples = of_half[0];
  samples.points.insert(samples.points.end(), of_half[1].points.begin(), of_half[1].points.end());
  samples.normals.insert(samples.normals.end(), of_half[1].normals.begin(), of_half[1].normals.end());
  return std::move(samples);
}

}  // namespace tensegric_fit::body_model
