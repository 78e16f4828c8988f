#include "reconstruction/noise.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/point_tree.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr std::size_t kSampled = 1000;
constexpr int kAround = 16;  // on a body of 40,000 points they span 15 mm, over which skin is flat to 0.3 mm

}  // namespace

double noise_of(const std::vector<Eigen::Vector3d>& points) {
  const geometry::PointTree tree(points);
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSampled);
  std::vector<double> off;
  std::vector<int> near;
  for (std::size_t i = 0; i < points.size(); i += step) {
    tree.nearest(points[i], kAround, near);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int n : near) mean += points[n] / static_cast<double>(near.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const int n : near) spread += (points[n] - mean) * (points[n] - mean).transpose();
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[0];
    // A plane takes three of the freedoms.
    off.push_back(std::sqrt(std::max(0.0, least) / std::max(1.0, static_cast<double>(near.size()) - 3)));
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle;
}

}  // namespace tensegric_fit::reconstruction
