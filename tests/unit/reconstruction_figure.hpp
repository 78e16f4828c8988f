/// A figure of capsules that stands on z = 0, with exact distances and simulated scans of it.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/point_cloud.hpp"

namespace figure {

struct Capsule {
  Eigen::Vector3d a, b;
  double radius;

  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return a + t * (b - a);
  }
  double distance(const Eigen::Vector3d& p) const { return (p - nearest(p)).norm() - radius; }
};

/// Trunk, head, legs that are cut off by the ground, arms that hang clear of the trunk.
inline std::vector<Capsule> body() {
  return {{{0, 0, 0.95}, {0, 0, 1.25}, 0.15},        {{0, 0, 1.40}, {0, 0, 1.55}, 0.08},
          {{0.09, 0, -0.1}, {0.09, 0, 0.90}, 0.07},  {{-0.09, 0, -0.1}, {-0.09, 0, 0.90}, 0.07},
          {{0.15, 0, 1.32}, {0.28, 0, 0.80}, 0.045}, {{-0.15, 0, 1.32}, {-0.28, 0, 0.80}, 0.045}};
}

/// Signed distance of the figure's surface, negative inside.
inline double distance(const Eigen::Vector3d& p) {
  double nearest = 1e9;
  for (const Capsule& c : body()) nearest = std::min(nearest, c.distance(p));
  return std::max(nearest, -p.z());
}

/// Evenly spread in [0, 1); the same on every platform.
inline double uniform(std::mt19937& random) {
  return random() / 4294967296.0;
}

inline double gaussian(std::mt19937& random) {
  return std::sqrt(-2 * std::log(1 - uniform(random))) * std::cos(2 * M_PI * uniform(random));
}

inline Eigen::Vector3d direction(std::mt19937& random) {
  return Eigen::Vector3d(gaussian(random), gaussian(random), gaussian(random)).normalized();
}

/// About `count` points with true normals, none below 6 mm: sensors do not see the soles.
inline tensegric_fit::geometry::PointCloud scan_body(int count, double noise, unsigned seed) {
  std::mt19937 random(seed);
  tensegric_fit::geometry::PointCloud cloud;
  const std::vector<Capsule> parts = body();
  std::vector<double> area;  // running sum
  for (const Capsule& c : parts)
    area.push_back((area.empty() ? 0 : area.back()) +
                   2 * M_PI * c.radius * ((c.b - c.a).norm() + 2 * c.radius));
  while (static_cast<int>(cloud.points.size()) < count) {
    const double pick = uniform(random) * area.back();
    const Capsule& c = parts[std::upper_bound(area.begin(), area.end(), pick) - area.begin()];
    const Eigen::Vector3d axis = (c.b - c.a).normalized(), n = direction(random);
    const double length = (c.b - c.a).norm(), s = uniform(random) * (length + 2 * c.radius) - c.radius;
    // A slice of a sphere has the area of its slice of the cylinder around it: s is even along both caps and
    // the tube.
    const double beyond = s < 0 ? s / c.radius : s > length ? (s - length) / c.radius : 0;
    const Eigen::Vector3d sideways = (n - axis.dot(n) * axis).normalized();
    const Eigen::Vector3d normal = beyond * axis + std::sqrt(1 - beyond * beyond) * sideways;
    const Eigen::Vector3d p = c.a + std::clamp(s, 0.0, length) * axis + c.radius * normal;
    if (p.z() < 0.006 || distance(p) < -1e-9) continue;
    cloud.points.push_back(p + noise * gaussian(random) * normal);
    cloud.normals.push_back(normal);
  }
  return cloud;
}

/// A scan without normals: the figure, a floor 1.6 m wide around it, and stray points.
inline tensegric_fit::geometry::PointCloud scan_booth(int body_points, double noise) {
  tensegric_fit::geometry::PointCloud cloud = scan_body(body_points, noise, 1);
  cloud.normals.clear();
  std::mt19937 random(2);
  for (int i = 0; i < body_points / 3; ++i) {
    const Eigen::Vector3d p(1.6 * uniform(random) - 0.8, 1.6 * uniform(random) - 0.8, 0);
    if (distance(p) > 0.005) cloud.points.push_back(p + noise * gaussian(random) * Eigen::Vector3d::UnitZ());
  }
  for (int i = 0; i < body_points / 500; ++i)
    cloud.points.emplace_back(1.6 * uniform(random) - 0.8, 1.6 * uniform(random) - 0.8,
                              1.8 * uniform(random));
  return cloud;
}

}  // namespace figure
