#include "correlation/distance_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/parallel_for.hpp"

namespace tensegric_fit::correlation {
namespace {

using Eigen::Vector3d;

struct Weighed {
  double value, area;
};

// Value below which that share of the area lies. \pre not empty
double quantile(std::vector<Weighed> values, double share) {
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  double all = 0, sum = 0;
  for (const Weighed& value : values) all += value.area;
  for (const Weighed& value : values)
    if ((sum += value.area) >= share * all) return value.value;
  return values.back().value;
}

// A third of the triangles around each vertex, m^2.
std::vector<double> areas_of(const std::vector<Vector3d>& vertices,
                             const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<double> areas(vertices.size(), 0.0);
  for (const Eigen::Vector3i& t : triangles)
    for (int k = 0; k < 3; ++k)
      areas[t[k]] += geometry::area_vector(vertices[t[0]], vertices[t[1]], vertices[t[2]]).norm() / 6;
  return areas;
}

}  // namespace

DistanceMap distance_map(const SimulatedBody& body, const std::vector<SkinPart>& parts,
                         const SeenSurface& worn, const Eigen::Isometry3d& simulated_from_worn,
                         double thickness) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(body.deformed, body.rest.triangles);
  const Eigen::Isometry3d worn_from_simulated = simulated_from_worn.inverse();
  DistanceMap map{std::vector<double>(parts.size(), 0.0), std::vector<char>(parts.size(), 0)};
  geometry::parallel_for(parts.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t v = begin; v < end; ++v) {
      if (parts[v] == SkinPart::mobile || !body.is_seen(v)) continue;
      const double out = parts[v] == SkinPart::covered ? thickness : 0;
      const Vector3d from = worn_from_simulated * Vector3d(body.deformed[v] + out * normals[v]);
      const SeenSurface::Place place = worn.nearest(from);
      const Vector3d way = place.position - from;
      if (!place.seen || way.norm() > kFarthest ||
          place.normal.dot(worn_from_simulated.linear() * normals[v]) < kAlike)
        continue;
      map.distance[v] = std::copysign(way.norm(), way.dot(place.normal));
      map.compared[v] = 1;
    }
  });
  return map;
}

Summary summary_of(const DistanceMap& map, const SimulatedBody& body, const std::vector<SkinPart>& parts,
                   SkinPart part) {
  const std::vector<double> areas = areas_of(body.deformed, body.rest.triangles);
  std::vector<Weighed> values, sizes;
  double all = 0, area = 0, sum = 0, size = 0, squares = 0;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    if (parts[v] != part) continue;
    all += areas[v];
    if (map.compared[v] == 0) continue;
    const double d = map.distance[v];
    values.push_back({d, areas[v]});
    sizes.push_back({std::abs(d), areas[v]});
    area += areas[v];
    sum += areas[v] * d;
    size += areas[v] * std::abs(d);
    squares += areas[v] * d * d;
  }
  if (!(area > 0)) return {};
  return {sum / area,
          quantile(std::move(values), 0.5),
          size / area,
          std::sqrt(squares / area),
          quantile(std::move(sizes), 0.95),
          area / all};
}

double compared_share(const DistanceMap& map, const SimulatedBody& body, const std::vector<SkinPart>& parts) {
  const std::vector<double> areas = areas_of(body.deformed, body.rest.triangles);
  const auto share = [&](bool only_moved) {
    double all = 0, compared = 0;
    for (std::size_t v = 0; v < parts.size(); ++v) {
      if (parts[v] != SkinPart::covered || (only_moved && body.deformed[v] == body.rest.vertices[v]))
        continue;
      all += areas[v];
      if (map.compared[v] != 0) compared += areas[v];
    }
    return all > 0 ? std::optional(compared / all) : std::nullopt;
  };
  return share(true).value_or(share(false).value_or(0));
}

}  // namespace tensegric_fit::correlation
