#include "surface_distance.hpp"

#include <algorithm>

#include "geometry/surface_tree.hpp"

namespace tensegric_fit::gauge {
namespace {

constexpr std::size_t kSampled = 4000;

}  // namespace

double quantile(std::vector<double> values, double share) {
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<long>(place), values.end());
  return values[place];
}

std::vector<double> distances(const std::vector<Eigen::Vector3d>& points, const std::vector<char>& left_out,
                              const geometry::TriangleMesh& surface) {
  const geometry::SurfaceTree tree(surface);
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSampled);
  std::vector<double> all;
  for (std::size_t i = 0; i < points.size(); i += step)
    if (left_out.empty() || !left_out[i])
      all.push_back((tree.nearest(points[i]).position - points[i]).norm());
  return all;
}

}  // namespace tensegric_fit::gauge
