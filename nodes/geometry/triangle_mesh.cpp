#include "geometry/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include "geometry/disjoint_sets.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::geometry {

std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh) {
  int highest = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) highest = std::max(highest, t.maxCoeff());
  std::vector<std::size_t> begin(highest + 2, 0);  // of each low vertex's sides
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++begin[std::min(t[k], t[(k + 1) % 3]) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<TriangleSide> sides(3 * mesh.triangles.size());
  std::vector<std::size_t> next = begin;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides[next[std::min(a, b)]++] = {std::min(a, b), std::max(a, b), static_cast<int>(3 * t) + k, a < b};
    }
  }
  for (std::size_t v = 0; v + 1 < begin.size(); ++v)
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              sides.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
              [](const TriangleSide& l, const TriangleSide& r) {
                return std::tie(l.high, l.number) < std::tie(r.high, r.number);
              });
  return sides;
}

void check_mesh(const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& v : mesh.vertices)
    if (!v.allFinite()) throw Refusal(refusal::kNonFinite, "the mesh has a vertex that is not finite");
  const int count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (t.minCoeff() < 0 || t.maxCoeff() >= count)
      throw Refusal(refusal::kBadMesh, "a triangle's vertex index is out of range");
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      throw Refusal(refusal::kBadMesh, "a triangle has two equal corners");
  }
}

std::vector<Eigen::Vector3d> vertex_normals(const std::vector<Eigen::Vector3d>& vertices,
                                            const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Vector3d> normals(vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3d n = area_vector(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
    for (int k = 0; k < 3; ++k) normals[t[k]] += n;
  }
  for (Eigen::Vector3d& n : normals) {
    const double length = n.norm();
    if (length > 0) n /= length;
  }
  return normals;
}

double cone_volume(const std::vector<Eigen::Vector3d>& vertices,
                   const std::vector<Eigen::Vector3i>& triangles, const Eigen::Vector3d& apex) {
  double six_volumes = 0;
  for (const Eigen::Vector3i& t : triangles)
    six_volumes += (vertices[t[0]] - apex).dot((vertices[t[1]] - apex).cross(vertices[t[2]] - apex));
  return six_volumes / 6;
}

std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  std::vector<Edge> edges;
  edges.reserve(sides.size() / 2 + 1);
  for (std::size_t i = 0; i < sides.size();) {
    const TriangleSide& h = sides[i];
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == h.low && sides[end].high == h.high) ++end;
    if (end - i > 2) throw Refusal(refusal::kBadMesh, "an edge of the mesh has more than two triangles");
    if (end - i == 2 && h.forward == sides[i + 1].forward)
      throw Refusal(refusal::kBadMesh,
                    "two neighbouring triangles of the mesh are oriented against each other");
    Edge edge{h.low, h.high, -1, -1};
    for (std::size_t j = i; j < end; ++j) (sides[j].forward ? edge.left : edge.right) = sides[j].triangle();
    if (edge.left < 0)
      std::swap(edge.left, edge.right);  // a boundary edge whose triangle runs from high to low
    edges.push_back(edge);
    i = end;
  }
  return edges;
}

bool is_closed(const TriangleMesh& mesh) {
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  if (sides.empty() || sides.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    const TriangleSide &a = sides[i], &b = sides[i + 1];
    if (a.low != b.low || a.high != b.high || a.forward == b.forward) return false;
    if (i + 2 < sides.size() && sides[i + 2].low == a.low && sides[i + 2].high == a.high) return false;
  }
  return true;
}

std::vector<std::vector<int>> neighbours_of(std::size_t vertex_count,
                                            const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<std::vector<int>> neighbours(vertex_count);
  for (const Eigen::Vector3i& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbours[t[k]].push_back(t[(k + 1) % 3]);
      neighbours[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (std::vector<int>& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

std::vector<int> components_of(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 1; k < 3; ++k) sets.join(t[0], t[k]);
  std::vector<int> number(mesh.vertices.size(), -1), component(mesh.triangles.size());
  int count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int r = sets.root(mesh.triangles[t][0]);
    if (number[r] < 0) number[r] = count++;
    component[t] = number[r];
  }
  return component;
}

TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<char>& keep) {
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (keep[t])
      for (int k = 0; k < 3; ++k) index[mesh.triangles[t][k]] = 0;
  TriangleMesh result;
  for (std::size_t v = 0; v < index.size(); ++v) {
    if (index[v] < 0) continue;
    index[v] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& old = mesh.triangles[t];
    if (keep[t]) result.triangles.emplace_back(index[old[0]], index[old[1]], index[old[2]]);
  }
  return result;
}

TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  TriangleMesh piece;
  std::vector<int> used;
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) used.push_back(mesh.triangles[t][k]);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const int v : used) piece.vertices.push_back(mesh.vertices[v]);
  for (const int t : triangles) {
    Eigen::Vector3i corners;
    for (int k = 0; k < 3; ++k)
      corners[k] =
          static_cast<int>(std::lower_bound(used.begin(), used.end(), mesh.triangles[t][k]) - used.begin());
    piece.triangles.push_back(corners);
  }
  return piece;
}

std::optional<Eigen::Vector3d> highest_near(const TriangleMesh& mesh, const Eigen::Vector3d& point,
                                            double below, double above) {
  constexpr double kFlat = 1e-15, kOnSide = 1e-9;  // m^2, shares: rounding
  std::optional<Eigen::Vector3d> highest;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double det = (b - a).x() * (c - a).y() - (c - a).x() * (b - a).y();
    if (std::abs(det) < kFlat) continue;
    const Eigen::Vector3d d = point - a;
    const double u = (d.x() * (c - a).y() - (c - a).x() * d.y()) / det,
                 v = ((b - a).x() * d.y() - d.x() * (b - a).y()) / det;
    if (u < -kOnSide || v < -kOnSide || u + v > 1 + kOnSide) continue;
    const double z = a.z() + u * (b - a).z() + v * (c - a).z();
    if (z > point.z() - below && z < point.z() + above && (!highest || z > highest->z()))
      highest = Eigen::Vector3d(point.x(), point.y(), z);
  }
  return highest;
}

std::array<Eigen::Vector3d, 2> bounding_box(const std::vector<Eigen::Vector3d>& points) {
  std::array<Eigen::Vector3d, 2> box{points.front(), points.front()};
  for (const Eigen::Vector3d& p : points) {
    box[0] = box[0].cwiseMin(p);
    box[1] = box[1].cwiseMax(p);
  }
  return box;
}

}  // namespace tensegric_fit::geometry
