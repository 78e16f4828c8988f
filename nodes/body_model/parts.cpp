#include "body_model/parts.hpp"

#include "body_model/matching.hpp"
#include "body_model/oriented_tree.hpp"
#include "geometry/halves.hpp"

namespace tensegric_fit::body_model {
namespace {

constexpr double kReach = 0.05;  // m that a normal turned by 60 degrees counts like

}  // namespace

std::vector<unsigned char> parts_of(const geometry::TriangleMesh& mesh, const RegisteredBody& body) {
  const Model& model = *body.model;
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  const OrientedTree tree(body.skin, geometry::vertex_normals(body.skin, model.triangles), kReach);
  std::vector<unsigned char> parts(mesh.vertices.size(), kUnknownPart);
  geometry::in_halves(parts.size(), [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t v = begin; v < end; ++v) {
      const int nearest = tree.nearest(mesh.vertices[v], normals[v]);
      if ((body.skin[nearest] - mesh.vertices[v]).norm() <= Matching::kUnmatched)
        parts[v] = model.part[nearest];
    }
  });
  return parts;
}

}  // namespace tensegric_fit::body_model
