#include "landmarks/body_shape.hpp"

#include "landmarks/crotch.hpp"

namespace tensegric_fit::landmarks {

BodyShape::BodyShape(geometry::TriangleMesh body_in_its_frame, std::vector<char> unseen_vertices)
    : mesh(std::move(body_in_its_frame)),
      filled(std::move(unseen_vertices)),
      normals(geometry::vertex_normals(mesh.vertices, mesh.triangles)),
      sliced(mesh),
      levels(find_levels(sliced)),
      crotch(find_crotch_junction(sliced, levels)),
      stature(levels.stature) {}

bool BodyShape::unseen(const Eigen::Vector3d& point, double radius) const {
  for (std::size_t v = 0; v < filled.size(); ++v)
    if (filled[v] != 0 && (mesh.vertices[v] - point).squaredNorm() < radius * radius) return true;
  return false;
}

}  // namespace tensegric_fit::landmarks
