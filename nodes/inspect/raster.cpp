#include "inspect/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel_for.hpp"

namespace tensegric_fit::inspect {
namespace {

double twice_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// std::floor and std::ceil are calls of a function where the processor is not known; a cast is not. \pre
// within an int's range
int floored(double x) {
  const int whole = static_cast<int>(x);
  return whole - static_cast<int>(whole > x);
}
int ceiled(double x) {
  const int whole = static_cast<int>(x);
  return whole + static_cast<int>(whole < x);
}

// First and last pixel whose centre lies in [low, high], within the picture.
std::pair<int, int> pixels(double low, double high, int size) {
  return {ceiled(std::clamp(low - 0.5, 0.0, double(size))),
          floored(std::clamp(high - 0.5, -1.0, size - 1.0))};
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
    if (first > last) return;
    constexpr double kRounding = 1e-9;  // pixels: a centre on an edge belongs to both triangles there
    const double at_zero = constant + down * y, zero = zero_per_weight * at_zero - 0.5;
    if (step > 0)
      first = std::max(first, ceiled(std::clamp(zero - kRounding, double(first), last + 1.0)));
    else if (step < 0)
      last = std::min(last, floored(std::clamp(zero + kRounding, first - 1.0, double(last))));
    else if (at_zero < 0)
      last = first - 1;
  }

  double step, down, constant, zero_per_weight;
};

// A triangle that covers pixels' centres, maybe, and where.
struct Covering {
  int index, first_row, last_row, first_column, last_column;
};

// Those that face the camera, if the mesh's normals point outward, and the others, in order.
struct Coverings {
  std::vector<Covering> front, back;
};

Coverings covering(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
                   int width, int height) {
  Coverings all;
  all.front.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Eigen::Vector3d &a = points[triangles[t][0]], &b = points[triangles[t][1]],
                          &c = points[triangles[t][2]];
    const auto [top, bottom] =
        pixels(std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}), height);
    if (top > bottom) continue;
    const auto [left, right] =
        pixels(std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}), width);
    if (left <= right)
      (twice_area(a, b, c) < 0 ? all.front : all.back)
          .push_back({static_cast<int>(t), top, bottom, left, right});
  }
  return all;
}

// Rows from `top` up to `bottom` only.
void draw_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Covering& covered, int top, int bottom, Raster& raster) {
  const double area = twice_area(a, b, c);
  if (area == 0) return;
  const Weight of_a(b, c, 1 / area), of_b(c, a, 1 / area), of_c(a, b, 1 / area);
  const double step = a.z() * of_a.step + b.z() * of_b.step + c.z() * of_c.step,
               down = a.z() * of_a.down + b.z() * of_b.down + c.z() * of_c.down;
  const auto single_step = static_cast<float>(step);
  for (int y = std::max(covered.first_row, top); y <= std::min(covered.last_row, bottom - 1); ++y) {
    int first = covered.first_column, last = covered.last_column;
    for (const Weight* weight : {&of_a, &of_b, &of_c}) weight->narrow(y + 0.5, first, last);
    float* depth = raster.depth[y];
    int* triangle = raster.triangle[y];
    auto z = static_cast<float>(a.z() + step * (first + 0.5 - a.x()) + down * (y + 0.5 - a.y()));
    for (int x = first; x <= last; ++x, z += single_step) {
      if (!(z < depth[x])) continue;
      depth[x] = z;
      triangle[x] = covered.index;
    }
  }
}

// The greatest depth of each tile of some rows. Where all is nearer than a triangle, nothing of it is
// seen: most of what faces away is passed over at this price.
class Tiles {
 public:
  Tiles(const Raster& raster, int top, int bottom)
      : top_(top),
        depth_((bottom - top + kTile - 1) / kTile, (raster.depth.cols + kTile - 1) / kTile,
               -std::numeric_limits<float>::infinity()) {
    for (int y = top; y < bottom; ++y)
      for (int x = 0; x < raster.depth.cols; ++x) {
        float& tile = depth_((y - top) / kTile, x / kTile);
        tile = std::max(tile, raster.depth(y, x));
      }
  }

  bool hide(const Covering& covered, double nearest) const {
    const int last_row = std::min((covered.last_row - top_) / kTile, depth_.rows - 1);
    for (int row = std::max(covered.first_row - top_, 0) / kTile; row <= last_row; ++row)
      for (int column = covered.first_column / kTile; column <= covered.last_column / kTile; ++column)
        if (!(depth_(row, column) < nearest)) return false;
    return true;
  }

 private:
  static constexpr int kTile = 8;  // pixels
  int top_;
  cv::Mat1f depth_;
};

}  // namespace

Raster rasterise(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
                 int width, int height) {
  Raster raster{cv::Mat1f(height, width), cv::Mat1i(height, width)};
  const Coverings seen = covering(points, triangles, width, height);
  // Each half of the rows takes the triangles in order.
  geometry::parallel_for(height, [&](std::size_t begin, std::size_t end, int) {
    const int top = static_cast<int>(begin), bottom = static_cast<int>(end);
    for (int y = top; y < bottom; ++y) {
      std::fill_n(raster.depth[y], width, std::numeric_limits<float>::infinity());
      std::fill_n(raster.triangle[y], width, -1);
    }
    const auto draw = [&](const Covering& covered) {
      const Eigen::Vector3i& t = triangles[covered.index];
      draw_triangle(points[t[0]], points[t[1]], points[t[2]], covered, top, bottom, raster);
    };
    const auto in_half = [&](const Covering& covered) {
      return covered.last_row >= top && covered.first_row < bottom;
    };
    for (const Covering& covered : seen.front)
      if (in_half(covered)) draw(covered);
    const Tiles tiles(raster, top, bottom);
    for (const Covering& covered : seen.back) {
      if (!in_half(covered)) continue;
      const Eigen::Vector3i& t = triangles[covered.index];
      if (!tiles.hide(covered, std::min({points[t[0]].z(), points[t[1]].z(), points[t[2]].z()})))
        draw(covered);
    }
  });
  return raster;
}

Eigen::Vector3d picture_barycentric(const Eigen::Vector2d& pixel, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d p(pixel.x(), pixel.y(), 0);
  return Eigen::Vector3d(twice_area(p, b, c), twice_area(a, p, c), twice_area(a, b, p)) / twice_area(a, b, c);
}

}  // namespace tensegric_fit::inspect
