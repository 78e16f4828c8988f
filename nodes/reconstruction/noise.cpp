#include "reconstruction/noise.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/local_plane.hpp"
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
    const double squares = std::max(0.0, geometry::local_plane(points, near).squares);
    // A plane takes three of the freedoms.
    off.push_back(std::sqrt(squares / std::max(1.0, static_cast<double>(near.size()) - 3)));
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle;
}

}  // namespace tensegric_fit::reconstruction
