#include "reconstruction/repair.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "geometry/status.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using geometry::TriangleMesh;

/// Side k of a triangle runs from corner k to corner k + 1. Corners are numbered 3 * triangle + k, sides like
/// the corners that they start from.
struct Side {
  int low, high, number;
  bool forward;
};

std::vector<Side> sorted_sides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(3 * t) + k, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.number) < std::tie(b.low, b.high, b.number);
  });
  return sides;
}

int next_corner(int corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// For each side the one across it in the neighbouring triangle, or -1 where it does not have exactly one
/// that runs back.
std::vector<int> sides_across(const TriangleMesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh);
  std::vector<int> across(sides.size(), -1);
  for (std::size_t i = 0, end; i < sides.size(); i = end) {
    for (end = i + 1;
         end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high;)
      ++end;
    if (end - i != 2 || sides[i].forward == sides[i + 1].forward) continue;
    across[sides[i].number] = sides[i + 1].number;
    across[sides[i + 1].number] = sides[i].number;
  }
  return across;
}

TriangleMesh largest_piece(const TriangleMesh& mesh) {
  const std::vector<int> component = geometry::components_of(mesh);
  std::vector<int> size(mesh.triangles.size());
  for (int c : component) ++size[c];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<char> keep(component.size());
  std::transform(component.begin(), component.end(), keep.begin(), [&](int c) { return c == largest; });
  return geometry::submesh(mesh, keep);
}

TriangleMesh without_degenerate(TriangleMesh mesh) {
  auto& triangles = mesh.triangles;
  const auto degenerate = [](const Eigen::Vector3i& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), degenerate), triangles.end());
  return mesh;
}

/// Gives each fan of triangles around a vertex a vertex of its own; fans end at sides without one partner.
TriangleMesh split_fans(const TriangleMesh& mesh) {
  const std::vector<int> across = sides_across(mesh);
  std::vector<int> fan(across.size());  // corners joined by the sides between their triangles
  std::iota(fan.begin(), fan.end(), 0);
  const auto root = [&fan](int corner) {
    while (fan[corner] != corner) corner = fan[corner] = fan[fan[corner]];
    return corner;
  };
  const auto join = [&](int a, int b) {
    const int ra = root(a), rb = root(b);
    fan[std::max(ra, rb)] = std::min(ra, rb);
  };
  for (int side = 0; side < static_cast<int>(across.size()); ++side) {
    if (across[side] < side) continue;
    join(side, next_corner(across[side]));
    join(next_corner(side), across[side]);
  }
  TriangleMesh result;
  result.triangles = mesh.triangles;
  std::vector<int> vertex(across.size(), -1);
  for (int corner = 0; corner < static_cast<int>(across.size()); ++corner) {
    const int r = root(corner);
    if (vertex[r] < 0) {
      vertex[r] = static_cast<int>(result.vertices.size());
      result.vertices.push_back(mesh.vertices[mesh.triangles[corner / 3][corner % 3]]);
    }
    result.triangles[corner / 3][corner % 3] = vertex[r];
  }
  return result;
}

/// Closes every boundary loop with a fan around the mean of its vertices. \pre no vertex has two fans
void close_loops(TriangleMesh& mesh) {
  const std::vector<int> across = sides_across(mesh);
  std::vector<int> next(mesh.vertices.size(), -1);  // along the boundary, against the sides' direction
  for (int side = 0; side < static_cast<int>(across.size()); ++side)
    if (across[side] < 0) {
      const int end = next_corner(side);
      next[mesh.triangles[end / 3][end % 3]] = mesh.triangles[side / 3][side % 3];
    }
  const int count = static_cast<int>(mesh.vertices.size());
  for (int start = 0; start < count; ++start) {
    if (next[start] < 0) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int length = 0;
    const int centre = static_cast<int>(mesh.vertices.size());
    for (int v = start; next[v] >= 0; ++length) {
      const int after = next[v];
      sum += mesh.vertices[v];
      mesh.triangles.emplace_back(v, after, centre);
      next[v] = -1;
      v = after;
    }
    mesh.vertices.push_back(sum / length);
  }
}

}  // namespace

TriangleMesh one_closed_surface(const TriangleMesh& surface) {
  TriangleMesh mesh = without_degenerate(surface);
  if (mesh.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kNotABody, "the points enclose nothing");
  mesh = largest_piece(mesh);
  constexpr int kMostRounds =
      4;  // splitting can leave several small pieces, and closing can touch old vertices
  for (int round = 0; round < kMostRounds; ++round) {
    mesh = split_fans(mesh);
    close_loops(mesh);
    mesh = largest_piece(mesh);
    if (geometry::is_closed(mesh)) break;
  }
  if (!geometry::is_closed(mesh))
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the reconstructed surface cannot be closed");
  if (geometry::cone_volume(mesh.vertices, mesh.triangles, mesh.vertices.front()) < 0)
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace tensegric_fit::reconstruction
