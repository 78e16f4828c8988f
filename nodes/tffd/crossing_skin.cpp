#include "tffd/crossing_skin.hpp"

#include <algorithm>

#include "geometry/crossing_triangles.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using geometry::Corners;
using Pairs = std::vector<std::pair<int, int>>;

std::vector<int> triangles_in(const Pairs& pairs) {
  std::vector<int> triangles;
  for (const auto& [a, b] : pairs) triangles.insert(triangles.end(), {a, b});
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

// Triangles that cross where skin faces skin: of one rounded skin, needles cross their neighbours, too.
Pairs facing_pairs(const std::vector<Vector3d>& places, const std::vector<Eigen::Vector3i>& triangles,
                   const std::vector<char>& looked_at) {
  Pairs pairs = geometry::crossing_pairs(places, triangles, looked_at);
  if (pairs.empty()) return pairs;
  const std::vector<Vector3d> normals = geometry::vertex_normals(places, triangles);
  const auto outward = [&](int triangle) -> Vector3d {
    const Eigen::Vector3i& t = triangles[triangle];
    return normals[t[0]] + normals[t[1]] + normals[t[2]];
  };
  const auto one_skin = [&](const std::pair<int, int>& pair) {
    return outward(pair.first).dot(outward(pair.second)) >= 0;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), one_skin), pairs.end());
  return pairs;
}

}  // namespace

std::vector<geometry::FitWarning> check_crossings(const WornSkin& skin, const std::vector<WornLine>& lines) {
  std::vector<char> looked_at(skin.rest.size());
  for (std::size_t v = 0; v < looked_at.size(); ++v) looked_at[v] = skin.rest[v] != skin.worn[v];
  const Pairs pairs = facing_pairs(skin.worn, skin.triangles, looked_at);
  if (pairs.empty()) return {};
  const std::vector<int> crossing = triangles_in(pairs);
  std::fill(looked_at.begin(), looked_at.end(), 0);
  for (const int i : crossing)
    for (const int v : skin.triangles[i]) looked_at[v] = 1;
  const auto corners = [&](const std::vector<Vector3d>& places, int triangle) {
    const Eigen::Vector3i& t = skin.triangles[triangle];
    return Corners{places[t[0]], places[t[1]], places[t[2]]};
  };
  Pairs deep_at_rest;
  for (const auto& [a, b] : facing_pairs(skin.rest, skin.triangles, looked_at))
    if (geometry::crossing_depth(corners(skin.rest, a), corners(skin.rest, b)) >= kLeastDepth)
      deep_at_rest.emplace_back(a, b);
  const std::vector<int> sunken = triangles_in(deep_at_rest);

  const auto number = [&](int triangle) {
    return static_cast<int>(std::lower_bound(crossing.begin(), crossing.end(), triangle) - crossing.begin());
  };
  Pairs joined;
  std::vector<double> depths(crossing.size());
  for (const auto& [a, b] : pairs) {
    joined.emplace_back(number(a), number(b));
    const double depth = geometry::crossing_depth(corners(skin.worn, a), corners(skin.worn, b));
    for (const int i : {number(a), number(b)}) depths[i] = std::max(depths[i], depth);
  }
  std::vector<geometry::FitWarning> found;
  for (const std::vector<int>& place : places_of(crossing, skin.triangles, joined)) {
    double depth = 0;
    bool is_sunken = false;
    std::vector<int> triangles;
    for (const int i : place) {
      depth = std::max(depth, depths[i]);
      is_sunken = is_sunken || std::binary_search(sunken.begin(), sunken.end(), crossing[i]);
      triangles.push_back(crossing[i]);
    }
    if (!is_sunken && depth >= kLeastDepth)
      found.push_back(warning_at(geometry::warning::kSkinCrosses, triangles, depth, skin, lines));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.value > b.value; });
  return found;
}

}  // namespace tensegric_fit::tffd
