#include "geometry/order_of_place.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

/// Bit i of the lowest 21 bits of `x` becomes bit 3 i.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// The vertices in a frame and a unit that the surface brings along: the axes along which it spreads least to
/// most, each towards where it reaches farther; its spread.
std::vector<Vector3d> seen_from_itself(const TriangleMesh& mesh) {
  std::vector<std::pair<Vector3d, double>> pieces;  // middle and area
  pieces.reserve(mesh.triangles.size());
  Vector3d mean = Vector3d::Zero();
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    pieces.emplace_back((a + b + c) / 3, area_vector(a, b, c).norm());
    mean += pieces.back().second * pieces.back().first;
    sum += pieces.back().second;
  }
  if (!(sum > 0)) return mesh.vertices;
  mean /= sum;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const auto& [middle, area] : pieces)
    squares += area / sum * (middle - mean) * (middle - mean).transpose();
  const double spread = std::sqrt(squares.trace());
  if (!(spread > 0)) return mesh.vertices;
  Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares).eigenvectors().transpose() / spread;
  Eigen::Array3d skew = Eigen::Array3d::Zero(), size = skew;
  for (const auto& [middle, area] : pieces) {
    const Eigen::Array3d cubes = (axes * (middle - mean)).array().cube();
    skew += area * cubes;
    size += area * cubes.abs();
  }
  constexpr double kAlike = 1e-9;  // what both sides of a symmetric surface differ by is rounding
  for (int axis = 0; axis < 3; ++axis)
    if (skew[axis] < -kAlike * size[axis]) axes.row(axis) = -axes.row(axis);
  std::vector<Vector3d> places;
  places.reserve(mesh.vertices.size());
  for (const Vector3d& p : mesh.vertices) places.emplace_back(axes * (p - mean));
  return places;
}

}  // namespace

std::vector<Eigen::Vector3i> in_order_of_place(const TriangleMesh& mesh) {
  constexpr double kCell =
      1.0 / 512;  // of the spread, a millimetre of a person; what shares a cell is sorted by its corners
  constexpr double kMost = (1 << 20) * kCell;  // each way: farther out all are in one cell
  const std::vector<Vector3d> places = seen_from_itself(mesh);
  const auto place = [&](int v) { return std::array{places[v].z(), places[v].y(), places[v].x()}; };
  std::vector<Eigen::Vector3i> triangles;
  std::vector<std::uint64_t> cells;
  triangles.reserve(mesh.triangles.size());
  cells.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    int first = 0;
    for (int k = 1; k < 3; ++k)
      if (place(t[k]) < place(t[first])) first = k;
    triangles.emplace_back(t[first], t[(first + 1) % 3], t[(first + 2) % 3]);
    const Vector3d middle = (places[t[0]] + places[t[1]] + places[t[2]]) / 3;
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = std::clamp(middle[axis], -kMost, kMost - kCell) + kMost;
      cell |= spread_bits(static_cast<std::uint64_t>(along / kCell)) << axis;
    }
    cells.push_back(cell);
  }
  std::vector<std::size_t> order(triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (cells[a] != cells[b]) return cells[a] < cells[b];
    for (int k = 0; k < 3; ++k)
      if (place(triangles[a][k]) != place(triangles[b][k]))
        return place(triangles[a][k]) < place(triangles[b][k]);
    return a < b;
  });
  std::vector<Eigen::Vector3i> result;
  result.reserve(order.size());
  for (const std::size_t f : order) result.push_back(triangles[f]);
  return result;
}

}  // namespace tensegric_fit::geometry
