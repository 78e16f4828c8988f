#include "landmarks/body_surface.hpp"

#include "body_model/parts.hpp"
#include "body_model/standing.hpp"
#include "geometry/points.hpp"

namespace tensegric_fit::landmarks {

using Eigen::Vector3d;

Eigen::Isometry3d body_frame(const body_model::RegisteredBody& body) {
  const Vector3d up = body.vertical, left = body_model::across(body, body_model::shipped_standing());
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear().row(0) = left.cross(up);
  frame.linear().row(1) = left;
  frame.linear().row(2) = up;
  Vector3d origin = 0.5 * (body.joint("foot.L") + body.joint("foot.R"));
  origin += (body.ground - up.dot(origin)) * up;
  frame.translation() = -(frame.linear() * origin);
  return frame;
}

Surface labelled(const geometry::TriangleMesh& mesh, const std::vector<char>& filled,
                 const body_model::RegisteredBody& body, const Eigen::Isometry3d& body_from_scan) {
  Surface surface{{geometry::moved(mesh.vertices, body_from_scan), mesh.triangles}, {}, filled};
  for (const int v : body_model::nearest_skin(mesh, body)) surface.arm.push_back(body.model->arm[v]);
  return surface;
}

Surface skin_of(const body_model::RegisteredBody& body, const std::vector<Vector3d>& skin,
                const Eigen::Isometry3d& body_from_scan) {
  return {{geometry::moved(skin, body_from_scan), body.model->triangles}, body.model->arm, {}};
}

}  // namespace tensegric_fit::landmarks
