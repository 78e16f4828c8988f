#include "geometry/shading_normals.hpp"

#include <algorithm>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

std::vector<Eigen::Vector3d> shading_normals(const std::vector<Eigen::Vector3d>& vertices,
                                             const std::vector<Eigen::Vector3i>& triangles) {
  const std::vector<Eigen::Vector3d> single = vertex_normals(vertices, triangles);
  std::vector<Eigen::Vector3d> normals(vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3d mean = (single[t[0]] + single[t[1]] + single[t[2]]).normalized();
    const double area = area_vector(vertices[t[0]], vertices[t[1]], vertices[t[2]]).norm();
    for (int k = 0; k < 3; ++k) {
      const double alike = std::max(0.0, single[t[k]].dot(mean)), square = alike * alike,
                   fourth = square * square;
      normals[t[k]] += area * fourth * fourth * mean;
    }
  }
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const double length = normals[v].norm();
    normals[v] = length > 0 ? Eigen::Vector3d(normals[v] / length) : single[v];
  }
  return normals;
}

}  // namespace tensegric_fit::geometry
