#include "crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::stability {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;
using Corners = std::array<Vector3d, 3>;

constexpr double kCell = 0.01;   // m, of the grid: a few triangles of skin
constexpr double kOff = 1e-5;    // m, outside the skin: where it is asked whether a vertex is inside the body

double orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

// Where a side of one goes through the inside of the other.
std::optional<Vector3d> passage(const Vector3d& from, const Vector3d& to, const Corners& t) {
  const double above = orientation(t[0], t[1], t[2], from), below = orientation(t[0], t[1], t[2], to);
  if (above * below >= 0) return {};
  const double a = orientation(from, to, t[0], t[1]), b = orientation(from, to, t[1], t[2]),
               c = orientation(from, to, t[2], t[0]);
  if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0))) return {};
  return from + above / (above - below) * (to - from);
}

std::vector<Vector3d> passages(const Corners& one, const Corners& other) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 3; ++i) {
    if (const auto p = passage(one[i], one[(i + 1) % 3], other)) points.push_back(*p);
    if (const auto p = passage(other[i], other[(i + 1) % 3], one)) points.push_back(*p);
  }
  return points;
}

Corners corners(const TriangleMesh& mesh, int triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

struct Box {
  Vector3d low, high;
  bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

Box box_of(const Corners& t) {
  return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])};
}

// The cells of a grid that a box touches.
template <typename Visit>
void for_cells(const Box& box, const Visit& visit) {
  const auto cell = [](double x) { return static_cast<long>(std::floor(x / kCell)); };
  for (long x = cell(box.low.x()); x <= cell(box.high.x()); ++x)
    for (long y = cell(box.low.y()); y <= cell(box.high.y()); ++y)
      for (long z = cell(box.low.z()); z <= cell(box.high.z()); ++z)
        visit((x * 1000003 + y) * 1000003 + z);
}

bool share_a_corner(const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[i] == b[j]) return true;
  return false;
}

bool is_inside(const TriangleMesh& mesh, const Vector3d& point) {
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point,
                   c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum > M_PI;  // half of the whole solid angle, 4 pi, as each term is half of a triangle's
}

}  // namespace

bool cross(const Corners& one, const Corners& other) {
  return !passages(one, other).empty();
}

std::vector<std::pair<int, int>> crossings(const TriangleMesh& mesh, const std::vector<char>& looked_at) {
  const int count = static_cast<int>(mesh.triangles.size());
  std::vector<char> is_looked_at(count);
  std::unordered_map<long, std::vector<int>> cells;  // of the triangles that are looked at
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    is_looked_at[i] = looked_at[t[0]] || looked_at[t[1]] || looked_at[t[2]];
    if (is_looked_at[i])
      for_cells(box_of(corners(mesh, i)), [&](long cell) { cells[cell].push_back(i); });
  }
  std::vector<std::pair<int, int>> found;
  std::vector<int> near;
  for (int i = 0; i < count; ++i) {
    const Corners t = corners(mesh, i);
    const Box box = box_of(t);
    near.clear();
    for_cells(box, [&](long cell) {
      if (const auto at = cells.find(cell); at != cells.end())
        near.insert(near.end(), at->second.begin(), at->second.end());
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const int j : near) {
      if (j == i || (is_looked_at[i] && j < i) || share_a_corner(mesh.triangles[i], mesh.triangles[j])) continue;
      const Corners other = corners(mesh, j);
      if (box.meets(box_of(other)) && cross(t, other)) found.emplace_back(std::min(i, j), std::max(i, j));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

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
    for (const Vector3d& p : passages(corners(mesh, a), corners(mesh, b))) points.push_back(p);
  const geometry::PointTree curves(points);
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
      patch.depths.push_back(std::min((tree.nearest(at).position - at).norm(), curves.distance(at)));
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

}  // namespace tensegric_fit::stability
