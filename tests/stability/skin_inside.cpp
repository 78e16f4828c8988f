#include "skin_inside.hpp"

#include <algorithm>
#include <map>

#include "geometry/crossing_triangles.hpp"
#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/surface_tree.hpp"
#include "geometry/winding_number.hpp"

namespace tensegric_fit::stability {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

constexpr double kOff = 1e-5;  // m, outside the skin: where it is asked whether a vertex is inside the body

geometry::Corners corners(const TriangleMesh& mesh, int triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

bool is_inside(const TriangleMesh& mesh, const Vector3d& point) {
  return geometry::winding_number(mesh, point) > 0.5;
}

}  // namespace

std::vector<SkinInside> skin_inside(const TriangleMesh& mesh, const std::vector<std::pair<int, int>>& pairs) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  const auto neighbours = geometry::neighbours_of(mesh.vertices.size(), mesh.triangles);
  enum : char { kUnknown, kAsked, kInside };
  std::vector<char> state(mesh.vertices.size(), kUnknown);
  std::vector<int> front, patch_of(mesh.vertices.size(), -1);
  const auto ask = [&](int v) {
    if (state[v] == kUnknown) {
      state[v] = kAsked;
      front.push_back(v);
    }
  };
  for (const auto& [a, b] : pairs)
    for (int k = 0; k < 3; ++k) {
      ask(mesh.triangles[a][k]);
      ask(mesh.triangles[b][k]);
    }
  while (!front.empty()) {
    const std::vector<int> asked = std::move(front);
    front.clear();
    geometry::parallel_for(asked.size(), [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t i = begin; i < end; ++i)
        if (is_inside(mesh, mesh.vertices[asked[i]] + kOff * normals[asked[i]])) state[asked[i]] = kInside;
    });
    for (const int v : asked)
      if (state[v] == kInside)
        for (const int next : neighbours[v]) ask(next);
  }
  std::vector<SkinInside> patches;
  if (pairs.empty()) return patches;
  std::vector<Vector3d> points;  // of the curves along which skin crosses skin
  for (const auto& [a, b] : pairs)
    for (const Vector3d& p : geometry::passages(corners(mesh, a), corners(mesh, b))) points.push_back(p);
  const geometry::PointTree curves(points);
  std::map<int, double> least;  // by corner of triangles that cross: what they are through each other by
  for (const auto& [a, b] : pairs) {
    const double depth = geometry::crossing_depth(corners(mesh, a), corners(mesh, b));
    for (const int triangle : {a, b})
      for (const int v : mesh.triangles[triangle]) least[v] = std::max(least[v], depth);
  }
  for (std::size_t first = 0; first < state.size(); ++first) {
    if (state[first] != kInside || patch_of[first] >= 0) continue;
    const int number = static_cast<int>(patches.size());
    SkinInside patch;
    std::vector<int> stack{static_cast<int>(first)};
    patch_of[first] = number;
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      patch.vertices.push_back(v);
      for (const int next : neighbours[v])
        if (state[next] == kInside && patch_of[next] < 0) {
          patch_of[next] = number;
          stack.push_back(next);
        }
    }
    std::sort(patch.vertices.begin(), patch.vertices.end());
    std::vector<char> keep(mesh.triangles.size());
    for (std::size_t t = 0; t < keep.size(); ++t)
      keep[t] = std::none_of(mesh.triangles[t].begin(), mesh.triangles[t].end(),
                             [&](int v) { return patch_of[v] == number; });
    const TriangleMesh others = geometry::submesh(mesh, keep);
    const geometry::SurfaceTree tree(others);
    for (const int v : patch.vertices) {
      const Vector3d& at = mesh.vertices[v];
      double depth = std::min((tree.nearest(at).position - at).norm(), curves.distance(at));
      // At the bottom of a crease 10 micrometres outside a corner may be inside.
      if (const auto crossed = least.find(v); crossed != least.end())
        depth = std::min(depth, crossed->second);
      patch.depths.push_back(depth);
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

}  // namespace tensegric_fit::stability
