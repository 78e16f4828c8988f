#include "inspect/skin_stretch.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tensegric_fit::inspect {
namespace {

// Singular values of a 3x2 matrix from its 2x2 product; the one farther from 1, by ratio.
double principal_stretch(const Eigen::Matrix<double, 3, 2>& gradient) {
  const Eigen::Matrix2d squared = gradient.transpose() * gradient;
  const double middle = squared.trace() / 2;
  const double half = std::hypot((squared(0, 0) - squared(1, 1)) / 2, squared(0, 1));
  const double most = std::sqrt(middle + half), least = std::sqrt(std::max(0.0, middle - half));
  return most * least > 1 ? most : least;
}

}  // namespace

SkinStretch::SkinStretch(const geometry::TriangleMesh& rest) : rest_(rest.vertices) {
  for (const Eigen::Vector3i& corners : rest.triangles) {
    const Eigen::Vector3d first = rest_[corners[1]] - rest_[corners[0]],
                          second = rest_[corners[2]] - rest_[corners[0]];
    const double length = first.norm(), area = first.cross(second).norm() / 2;
    if (area == 0) continue;  // a needle without area has no plane
    const double along = first.dot(second) / length;
    Eigen::Matrix2d edges;
    edges << length, along, 0, 2 * area / length;
    patches_.push_back({corners, edges.inverse(), area});
  }
}

std::vector<double> SkinStretch::at(const std::vector<Eigen::Vector3d>& vertices) const {
  std::vector<double> sums(rest_.size(), 0), areas(rest_.size(), 0);
  const auto stays = [&](int v) { return vertices[v] == rest_[v]; };
  for (const Patch& patch : patches_) {
    const auto& [a, b, c] = std::tie(patch.corners[0], patch.corners[1], patch.corners[2]);
    double stretch = 1;
    if (!stays(a) || !stays(b) || !stays(c)) {
      Eigen::Matrix<double, 3, 2> edges;
      edges << vertices[b] - vertices[a], vertices[c] - vertices[a];
      stretch = principal_stretch(edges * patch.from_plane);
    }
    for (const int v : {a, b, c}) {
      sums[v] += patch.area * (stretch - 1);
      areas[v] += patch.area;
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = areas[v] > 0 ? 1 + sums[v] / areas[v] : 1;
  return sums;
}

}  // namespace tensegric_fit::inspect
