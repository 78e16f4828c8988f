#include "body_model/parts.hpp"

#include "body_model/matching.hpp"
#include "body_model/missing_parts.hpp"
#include "geometry/oriented_tree.hpp"
#include "geometry/parallel_for.hpp"

namespace tensegric_fit::body_model {
std::vector<int> nearest_skin(const geometry::TriangleMesh& mesh, const RegisteredBody& body) {
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  const std::vector<char> lost = lost_skin(body);
  const std::vector<Eigen::Vector3d> all = geometry::vertex_normals(body.skin, body.model->triangles);
  std::vector<int> vertex;
  std::vector<Eigen::Vector3d> skin, skin_normals;
  for (std::size_t v = 0; v < lost.size(); ++v) {
    if (lost[v]) continue;
    vertex.push_back(static_cast<int>(v));
    skin.push_back(body.skin[v]);
    skin_normals.push_back(all[v]);
  }
  const geometry::OrientedTree tree(skin, skin_normals);
  std::vector<int> nearest(mesh.vertices.size());
  geometry::parallel_for(nearest.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t v = begin; v < end; ++v) nearest[v] = vertex[tree.nearest(mesh.vertices[v], normals[v])];
  });
  return nearest;
}

std::vector<unsigned char> parts_of(const geometry::TriangleMesh& mesh, const RegisteredBody& body) {
  const std::vector<int> nearest = nearest_skin(mesh, body);
  std::vector<unsigned char> parts(nearest.size(), kUnknownPart);
  for (std::size_t v = 0; v < parts.size(); ++v)
    if ((body.skin[nearest[v]] - mesh.vertices[v]).norm() <= Matching::kUnmatched)
      parts[v] = body.model->part[nearest[v]];
  return parts;
}

}  // namespace tensegric_fit::body_model
