#include "inspect/pointing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace tensegric_fit::inspect {

std::optional<geometry::SurfacePoint> first_hit(const std::vector<Eigen::Vector3d>& vertices,
                                                const std::vector<Eigen::Vector3i>& triangles,
                                                const Eigen::Vector3d& from,
                                                const Eigen::Vector3d& direction) {
  // Moeller and Trumbore's test, on triangles that face the ray.
  std::optional<geometry::SurfacePoint> hit;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Eigen::Vector3d& origin = vertices[triangles[t][0]];
    const Eigen::Vector3d first = vertices[triangles[t][1]] - origin,
                          second = vertices[triangles[t][2]] - origin, across = direction.cross(second);
    const double volume = first.dot(across);
    if (volume <= 0) continue;
    const Eigen::Vector3d way = from - origin, turned = way.cross(first);
    const double u = way.dot(across) / volume, v = direction.dot(turned) / volume,
                 distance = second.dot(turned) / volume;
    if (u < 0 || v < 0 || u + v > 1 || distance < 0 || distance >= nearest) continue;
    nearest = distance;
    hit = geometry::SurfacePoint{static_cast<int>(t), {1 - u - v, u, v}, from + distance * direction};
  }
  return hit;
}

double value_at(const geometry::SurfacePoint& place, const std::vector<Eigen::Vector3i>& triangles,
                const std::vector<double>& values) {
  double value = 0;
  for (int corner = 0; corner < 3; ++corner)
    value += place.barycentric[corner] * values[triangles[place.triangle][corner]];
  return value;
}

std::string spoken(const std::string& landmark) {
  std::string words = landmark;
  for (const auto& [ending, side] : {std::pair("_L", "left "), std::pair("_R", "right ")})
    if (words.size() > 2 && words.compare(words.size() - 2, 2, ending) == 0) {
      words = side + words.substr(0, words.size() - 2);
      break;
    }
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

}  // namespace tensegric_fit::inspect
