#include "reconstruction/soles.hpp"

#include <algorithm>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr double kLow = 0.03;     // m, height of the points that draw the outlines
constexpr double kPixel = 0.004;  // m
constexpr int kGap = 2;           // pixels; gaps of up to twice that in an outline are closed
constexpr int kInset =
    1;  // pixels that the sole stays inside its outline, since that bulges above the ground

/// A black and white picture of the outlines, with a margin.
struct Picture {
  int width, height;
  std::vector<char> set;

  Picture(int w, int h) : width(w), height(h), set(static_cast<std::size_t>(w) * h) {}
  char& at(int x, int y) { return set[static_cast<std::size_t>(y) * width + x]; }
};

/// Sets every pixel within `radius` pixels of one that has `value` to `value`.
void spread(Picture& picture, char value, int radius) {
  Picture before = picture;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (before.at(x, y) != value) continue;
      for (int v = std::max(0, y - radius); v <= std::min(picture.height - 1, y + radius); ++v)
        for (int u = std::max(0, x - radius); u <= std::min(picture.width - 1, x + radius); ++u)
          if ((u - x) * (u - x) + (v - y) * (v - y) <= radius * radius) picture.at(u, v) = value;
    }
  }
}

/// Sets what the margin cannot reach.
void fill(Picture& picture) {
  Picture outside(picture.width, picture.height);
  std::vector<std::pair<int, int>> front(1, {0, 0});
  outside.at(0, 0) = 1;
  while (!front.empty()) {
    const auto [x, y] = front.back();
    front.pop_back();
    for (const auto& [u, v] : {std::pair{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
      if (u < 0 || v < 0 || u >= picture.width || v >= picture.height || outside.at(u, v) || picture.at(u, v))
        continue;
      outside.at(u, v) = 1;
      front.emplace_back(u, v);
    }
  }
  for (std::size_t i = 0; i < picture.set.size(); ++i) picture.set[i] = !outside.set[i];
}

}  // namespace

geometry::PointCloud sole_points(const std::vector<Eigen::Vector3d>& body) {
  std::vector<Eigen::Vector3d> low;
  std::copy_if(body.begin(), body.end(), std::back_inserter(low),
               [](const Eigen::Vector3d& p) { return p.z() < kLow; });
  if (low.empty()) return {};
  const auto box = geometry::bounding_box(low);
  const int margin = kGap + 2;
  const auto pixel = [&](const Eigen::Vector3d& p, int axis) {
    return static_cast<int>((p[axis] - box[0][axis]) / kPixel) + margin;
  };
  Picture picture(pixel(box[1], 0) + margin + 1, pixel(box[1], 1) + margin + 1);
  for (const Eigen::Vector3d& p : low) picture.at(pixel(p, 0), pixel(p, 1)) = 1;
  spread(picture, 1, kGap);
  fill(picture);
  spread(picture, 0, kGap + kInset);

  geometry::PointCloud soles;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (picture.at(x, y))
        soles.points.emplace_back(box[0].x() + (x - margin + 0.5) * kPixel,
                                  box[0].y() + (y - margin + 0.5) * kPixel, 0);
  soles.normals.assign(soles.points.size(), -Eigen::Vector3d::UnitZ());
  return soles;
}

}  // namespace tensegric_fit::reconstruction
