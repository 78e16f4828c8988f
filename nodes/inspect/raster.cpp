#include "inspect/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/utility.hpp>

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

// A corner's weight is linear over the picture; inside the triangle none is negative.
struct Weight {
  Weight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double scale)
      : step(scale * (a.y() - b.y())),
        down(scale * (b.x() - a.x())),
        constant(scale * (a.x() * b.y() - a.y() * b.x())),
        zero_per_weight(step == 0 ? 0 : -1 / step) {}

  // Narrows the pixels of the row with its centre at y to those inside.
  void narrow(double y, int& first, int& last) const {
    constexpr double kRounding = 1e-9;  // pixels: a centre on an edge belongs to both triangles there
    const double at_zero = constant + down * y;
    if (step > 0)
      first = std::max(
          first,
          static_cast<int>(std::ceil(std::min(zero_per_weight * at_zero - 0.5 - kRounding, last + 1.0))));
    else if (step < 0)
      last = std::min(
          last,
          static_cast<int>(std::floor(std::max(zero_per_weight * at_zero - 0.5 + kRounding, first - 1.0))));
    else if (at_zero < 0)
      last = first - 1;
  }

  double step, down, constant, zero_per_weight;
};

// Rows from `top` up to `bottom` only.
void draw_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, int index,
                   int top, int bottom, Raster& raster) {
  const auto [first_row, last_row] =
      pixels(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), raster.depth.rows);
  if (last_row < top || first_row >= bottom || first_row > last_row) return;
  const auto [first_column, last_column] =
      pixels(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), raster.depth.cols);
  if (first_column > last_column) return;
  const double area = twice_area(a, b, c);
  if (area == 0) return;
  const Weight of_a(b, c, 1 / area), of_b(c, a, 1 / area), of_c(a, b, 1 / area);
  const double step = a.z() * of_a.step + b.z() * of_b.step + c.z() * of_c.step,
               down = a.z() * of_a.down + b.z() * of_b.down + c.z() * of_c.down;
  for (int y = std::max(first_row, top); y <= std::min(last_row, bottom - 1); ++y) {
    int first = first_column, last = last_column;
    for (const Weight* weight : {&of_a, &of_b, &of_c}) weight->narrow(y + 0.5, first, last);
    float* depth = raster.depth[y];
    int* triangle = raster.triangle[y];
    double z = a.z() + step * (first + 0.5 - a.x()) + down * (y + 0.5 - a.y());
    for (int x = first; x <= last; ++x, z += step) {
      if (!(static_cast<float>(z) < depth[x])) continue;
      depth[x] = static_cast<float>(z);
      triangle[x] = index;
    }
  }
}

}  // namespace

Raster rasterise(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
                 int width, int height) {
  Raster raster{cv::Mat1f(height, width), cv::Mat1i(height, width)};
  // Each strip of rows takes the triangles in order, so the number of threads changes nothing.
  constexpr int kStrips = 4;
  cv::parallel_for_(cv::Range(0, kStrips), [&](const cv::Range& strips) {
    const int top = strips.start * height / kStrips, bottom = strips.end * height / kStrips;
    for (int y = top; y < bottom; ++y) {  // each strip by its own thread
      std::fill_n(raster.depth[y], width, std::numeric_limits<float>::infinity());
      std::fill_n(raster.triangle[y], width, -1);
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
      draw_triangle(points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]],
                    static_cast<int>(t), top, bottom, raster);
  });
  return raster;
}

Eigen::Vector3d picture_barycentric(const Eigen::Vector2d& pixel, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d p(pixel.x(), pixel.y(), 0);
  return Eigen::Vector3d(twice_area(p, b, c), twice_area(a, p, c), twice_area(a, b, p)) / twice_area(a, b, c);
}

}  // namespace tensegric_fit::inspect
