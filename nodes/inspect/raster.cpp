#include "inspect/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tensegric_fit::inspect {
namespace {

double twice_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// First and last pixel whose centre lies in [low, high], within the picture.
std::pair<int, int> pixels(double low, double high, int size) {
  return {static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, double(size))),
          static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, size - 1.0))};
}

void draw_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, int index,
                   Raster& raster) {
  const double area = twice_area(a, b, c);
  if (area == 0) return;
  const double scale = 1 / area;
  const auto [first_column, last_column] =
      pixels(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), raster.depth.cols);
  const auto [first_row, last_row] =
      pixels(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), raster.depth.rows);
  for (int y = first_row; y <= last_row; ++y) {
    float* depth = raster.depth[y];
    int* triangle = raster.triangle[y];
    for (int x = first_column; x <= last_column; ++x) {
      const Eigen::Vector3d p(x + 0.5, y + 0.5, 0);
      const double wa = scale * twice_area(p, b, c), wb = scale * twice_area(a, p, c),
                   wc = scale * twice_area(a, b, p);
      if (wa < 0 || wb < 0 || wc < 0) continue;
      const float z = static_cast<float>(wa * a.z() + wb * b.z() + wc * c.z());
      if (z >= depth[x]) continue;
      depth[x] = z;
      triangle[x] = index;
    }
  }
}

}  // namespace

Raster rasterise(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
                 int width, int height) {
  Raster raster{cv::Mat1f(height, width, std::numeric_limits<float>::infinity()),
                cv::Mat1i(height, width, -1)};
  for (std::size_t t = 0; t < triangles.size(); ++t)
    draw_triangle(points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]],
                  static_cast<int>(t), raster);
  return raster;
}

Eigen::Vector3d picture_barycentric(const Eigen::Vector2d& pixel, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d p(pixel.x(), pixel.y(), 0);
  return Eigen::Vector3d(twice_area(p, b, c), twice_area(a, p, c), twice_area(a, b, p)) / twice_area(a, b, c);
}

}  // namespace tensegric_fit::inspect
