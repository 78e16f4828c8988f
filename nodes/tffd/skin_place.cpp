#include "tffd/skin_place.hpp"

#include <algorithm>
#include <map>

#include "geometry/disjoint_sets.hpp"
#include "geometry/section.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::tffd {

std::vector<std::vector<int>> places_of(const std::vector<int>& picked,
                                        const std::vector<Eigen::Vector3i>& triangles,
                                        const std::vector<std::pair<int, int>>& joined) {
  geometry::DisjointSets sets(picked.size());
  std::map<int, int> first_at;  // vertex -> the first picked triangle there
  for (std::size_t i = 0; i < picked.size(); ++i)
    for (const int v : triangles[picked[i]]) {
      const auto [at, is_new] = first_at.emplace(v, static_cast<int>(i));
      if (!is_new) sets.join(at->second, static_cast<int>(i));
    }
  for (const auto& [a, b] : joined) sets.join(a, b);
  std::vector<std::vector<int>> found;
  std::map<int, std::size_t> place;
  for (std::size_t i = 0; i < picked.size(); ++i) {
    const auto [at, is_new] = place.emplace(sets.root(static_cast<int>(i)), found.size());
    if (is_new) found.emplace_back();
    found[at->second].push_back(static_cast<int>(i));
  }
  return found;
}

void take_place(const std::vector<int>& triangles, const WornSkin& skin, geometry::FitWarning& warning) {
  std::vector<double> areas;
  for (const int i : triangles) {
    const Eigen::Vector3i& t = skin.triangles[i];
    areas.push_back(geometry::area_vector(skin.rest[t[0]], skin.rest[t[1]], skin.rest[t[2]]).norm() / 2);
    warning.area += areas.back();
  }
  const std::vector<Eigen::Vector3d>& scanned = skin.scanned != nullptr ? *skin.scanned : skin.rest;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const double share = warning.area > 0 ? areas[i] / warning.area : 1.0 / static_cast<double>(areas.size());
    for (const int v : skin.triangles[triangles[i]]) {
      warning.at_rest += share / 3 * scanned[v];
      warning.worn += share / 3 * skin.worn[v];
      warning.vertices.push_back(v);
    }
  }
  std::sort(warning.vertices.begin(), warning.vertices.end());
  warning.vertices.erase(std::unique(warning.vertices.begin(), warning.vertices.end()),
                         warning.vertices.end());
}

geometry::FitWarning warning_at(const char* code, const std::vector<int>& triangles, double value,
                                const WornSkin& skin, const std::vector<WornLine>& lines) {
  geometry::FitWarning warning;
  warning.code = code;
  warning.value = value;
  take_place(triangles, skin, warning);
  double nearest = kNearLine;
  for (const WornLine& line : lines)
    if (const double distance = geometry::distance_to_line(warning.worn, line.worn); distance < nearest) {
      nearest = distance;
      warning.line = line.name;
    }
  return warning;
}

}  // namespace tensegric_fit::tffd
