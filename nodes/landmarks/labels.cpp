#include "landmarks/labels.hpp"

#include "body_model/oriented_tree.hpp"
#include "geometry/halves.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 0.05;  // m that a normal turned by 60 degrees counts like

std::vector<Vector3d> moved(const std::vector<Vector3d>& points, const Eigen::Isometry3d& by) {
  std::vector<Vector3d> result;
  for (const Vector3d& p : points) result.push_back(by * p);
  return result;
}

}  // namespace

Surface labelled(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                 const body_model::RegisteredBody& body, const Eigen::Isometry3d& body_from_scan) {
  const body_model::Model& model = *body.model;
  const std::size_t count = mesh.vertices.size();
  Surface surface{{moved(mesh.vertices, body_from_scan), mesh.triangles},
                  std::vector<double>(count),
                  std::vector<unsigned char>(count),
                  filled};
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  const body_model::OrientedTree tree(body.skin, geometry::vertex_normals(body.skin, model.triangles),
                                      kReach);
  geometry::in_halves(count, [&](std::size_t begin, std::size_t end, int) {
    for (std::size_t v = begin; v < end; ++v) {
      const int nearest = tree.nearest(mesh.vertices[v], normals[v]);
      surface.arm[v] = model.arm[nearest];
      surface.part[v] = model.part[nearest];
    }
  });
  return surface;
}

Surface skin_of(const body_model::RegisteredBody& body, const Eigen::Isometry3d& body_from_scan) {
  return {{moved(body.skin, body_from_scan), body.model->triangles}, body.model->arm, body.model->part, {}};
}

}  // namespace tensegric_fit::landmarks
