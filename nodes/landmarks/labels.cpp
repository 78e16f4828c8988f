#include "landmarks/labels.hpp"

#include "body_model/parts.hpp"
#include "geometry/points.hpp"

namespace tensegric_fit::landmarks {
Surface labelled(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                 const body_model::RegisteredBody& body, const Eigen::Isometry3d& body_from_scan) {
  Surface surface{{geometry::moved(mesh.vertices, body_from_scan), mesh.triangles}, {}, filled};
  for (const int v : body_model::nearest_skin(mesh, body)) surface.arm.push_back(body.model->arm[v]);
  return surface;
}

Surface skin_of(const body_model::RegisteredBody& body, const std::vector<Eigen::Vector3d>& skin,
                const Eigen::Isometry3d& body_from_scan) {
  return {{geometry::moved(skin, body_from_scan), body.model->triangles}, body.model->arm, {}};
}

}  // namespace tensegric_fit::landmarks
