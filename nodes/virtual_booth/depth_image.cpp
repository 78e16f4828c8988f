#include "virtual_booth/depth_image.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tensegric_fit::virtual_booth {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d Lens::bent(const Vector2d& straight) const {
  const double x = straight.x(), y = straight.y(), r2 = straight.squaredNorm();
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Vector2d Lens::straight(const Vector2d& seen) const {
  constexpr int kMostSteps = 200;
  constexpr double kNear = 1e-12;
  Vector2d guess = seen;
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector2d off = bent(guess) - seen;
    guess -= off;
    if (off.norm() < kNear) break;
  }
  return guess;
}

DepthImage::DepthImage(const Sensor& sensor, int rows, int columns)
    : sensor_(sensor),
      rows_(rows),
      columns_(columns),
      pixels_(static_cast<std::size_t>(rows) * columns, {std::numeric_limits<double>::infinity(), 0}) {
  if (sensor.lens.none()) return;
  std::vector<Vector2d> rays;
  rays.reserve(pixels_.size());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vector3d seen = ray(row, column);
      const Vector2d straight = sensor.lens.straight({seen.x(), -seen.y()});
      rays.emplace_back(straight.x(), -straight.y());
    }
  }
  rays_ = std::move(rays);
}

Vector2d DepthImage::pixel_of(const Vector3d& p) const {
  Vector2d seen(p.x() / p.z(), p.y() / p.z());
  if (!sensor_.lens.none()) {
    const Vector2d bent = sensor_.lens.bent({seen.x(), -seen.y()});
    seen = {bent.x(), -bent.y()};
  }
  return {(seen.x() / sensor_.half_width + 1) / 2 * columns_,
          (1 - seen.y() / sensor_.half_height) / 2 * rows_};
}

Vector3d DepthImage::ray(int row, int column) const {
  if (!rays_.empty()) {
    const Vector2d& ray = rays_[static_cast<std::size_t>(row) * columns_ + column];
    return {ray.x(), ray.y(), 1};
  }
  return {sensor_.half_width * ((2 * column + 1.0) / columns_ - 1),
          sensor_.half_height * (1 - (2 * row + 1.0) / rows_), 1};
}

void DepthImage::draw(const geometry::TriangleMesh& mesh) {
  constexpr double kNearest = 0.05;
  std::vector<Vector3d> seen;
  seen.reserve(mesh.vertices.size());
  for (const Vector3d& p : mesh.vertices) seen.push_back(sensor_.axes * (p - sensor_.position));

  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
    if (a.z() < kNearest || b.z() < kNearest || c.z() < kNearest) continue;
    const Vector3d normal = geometry::area_vector(a, b, c);
    const double plane = normal.dot(a), area = normal.norm();
    if (area == 0) continue;
    // Pixels of the box round the triangle; a lens bends its sides by less than a pixel.
    const Vector2d at = pixel_of(a), bt = pixel_of(b), ct = pixel_of(c);
    const double margin = sensor_.lens.none() ? 0 : 1;
    const double left = std::min({at.x(), bt.x(), ct.x()}) - margin,
                 right = std::max({at.x(), bt.x(), ct.x()}) + margin;
    const double top = std::min({at.y(), bt.y(), ct.y()}) - margin,
                 bottom = std::max({at.y(), bt.y(), ct.y()}) + margin;
    if (right < 0 || left > columns_ || bottom < 0 || top > rows_) continue;
    const int first_row = std::max(0, static_cast<int>(top)),
              last_row = std::min(rows_ - 1, static_cast<int>(bottom));
    const int first = std::max(0, static_cast<int>(left)),
              last = std::min(columns_ - 1, static_cast<int>(right));
    // A ray from the sensor passes the triangle on the same side of the three planes through it and an edge.
    const Vector3d ab = a.cross(b), bc = b.cross(c), ca = c.cross(a);
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first; column <= last; ++column) {
        const Vector3d r = ray(row, column);
        const double u = r.dot(ab), v = r.dot(bc), w = r.dot(ca);
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) continue;
        const double slope = normal.dot(r);
        if (slope == 0) continue;
        const double depth = plane / slope;
        Pixel& pixel = pixels_[static_cast<std::size_t>(row) * columns_ + column];
        if (depth >= pixel.depth) continue;
        pixel = {depth, std::min(1.0, std::abs(slope) / (area * r.norm()))};
      }
    }
  }
}

void DepthImage::draw_floor(double radius) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Vector3d direction = sensor_.axes.transpose() * ray(row, column);
      if (direction.z() >= 0) continue;
      const double depth = -sensor_.position.z() / direction.z();
      const Vector3d point = sensor_.position + depth * direction;
      Pixel& pixel = pixels_[static_cast<std::size_t>(row) * columns_ + column];
      if (depth > 0 && depth < pixel.depth && point.head<2>().norm() < radius)
        pixel = {depth, -direction.z() / direction.norm()};
    }
  }
}

std::vector<Hit> DepthImage::hits() const {
  std::vector<Hit> result;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Pixel& pixel = pixels_[static_cast<std::size_t>(row) * columns_ + column];
      if (!std::isfinite(pixel.depth)) continue;
      const Vector3d point = sensor_.position + sensor_.axes.transpose() * (pixel.depth * ray(row, column));
      result.push_back({row, column, point, pixel.incidence});
    }
  }
  return result;
}

}  // namespace tensegric_fit::virtual_booth
