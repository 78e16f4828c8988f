#include "virtual_body/scan_pose.hpp"

#include <algorithm>

namespace tensegric_fit::virtual_body {

using Eigen::Vector3d;

void place_in_scan(double yaw, double tilt, VirtualBody& body) {
  Eigen::Isometry3d scan_from_body = Eigen::Isometry3d::Identity();
  scan_from_body.linear() =
      (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(tilt, Vector3d::UnitY()))
          .toRotationMatrix();
  if (tilt != 0) {
    double lowest = 0;
    for (const Vector3d& p : body.mesh.vertices) lowest = std::min(lowest, (scan_from_body * p).z());
    scan_from_body.translation().z() = -lowest;
  }
  body.truth.body_from_scan = scan_from_body.inverse();
  for (Vector3d& p : body.mesh.vertices) p = scan_from_body * p;
  for (geometry::Landmark& landmark : body.truth.landmarks)
    landmark.position = scan_from_body * landmark.position;
  for (geometry::GirthLoop& loop : body.truth.loops)
    for (Vector3d& p : loop.points) p = scan_from_body * p;
  for (auto& [name, direction] : body.doubts.loose) direction = scan_from_body.linear() * direction;
}

}  // namespace tensegric_fit::virtual_body
