#include "virtual_booth/depth_image.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tensegric_fit::virtual_booth {

using Eigen::Vector3d;

DepthImage::DepthImage(const Sensor& sensor, int rows, int columns)
    : sensor_(sensor),
      rows_(rows),
      columns_(columns),
      pixels_(static_cast<std::size_t>(rows) * columns, {std::numeric_limits<double>::infinity(), 0}) {}

Vector3d DepthImage::ray(int row, int column) const {
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
    // Pixels of the box round the triangle
    const auto column_of = [&](const Vector3d& p) {
      return (p.x() / p.z() / sensor_.half_width + 1) / 2 * columns_;
    };
    const auto row_of = [&](const Vector3d& p) {
      return (1 - p.y() / p.z() / sensor_.half_height) / 2 * rows_;
    };
    const auto [left, right] = std::minmax({column_of(a), column_of(b), column_of(c)});
    const auto [top, bottom] = std::minmax({row_of(a), row_of(b), row_of(c)});
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
