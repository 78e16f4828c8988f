#include "tffd/frame.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "geometry/nearest_on_sides.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::tffd {
namespace {

// W may lean this little off the triangle's plane, or the triangle be this thin, before 1e-12 could no longer
// be held.
constexpr double kFlat = 1e-4;

}  // namespace

Eigen::Vector3d Frame::closest(const Eigen::Vector3d& q) const {
  const Eigen::Vector2d uv = in_plane_from_offset * (q - corners[0]);
  const Eigen::Vector3d inside(1 - uv[0] - uv[1], uv[0], uv[1]);
  if (inside.minCoeff() >= 0) return inside;
  return geometry::nearest_on_sides(corners, inside, q);
}

std::vector<Frame> frames_of(const geometry::ControlMesh& control, Axis axis) {
  std::vector<Frame> frames;
  frames.reserve(control.triangles.size());
  for (const Eigen::Vector3i& t : control.triangles) {
    Frame frame;
    for (int k = 0; k < 3; ++k) frame.corners[k] = control.outer[t[k]];
    const Eigen::Vector3d u = frame.corners[1] - frame.corners[0], v = frame.corners[2] - frame.corners[0];
    const Eigen::Vector3d twice_area = u.cross(v);
    if (!(twice_area.norm() > kFlat * u.norm() * v.norm()))
      throw geometry::Refusal(geometry::refusal::kBadMesh,
                              "control triangle " + std::to_string(frames.size()) + " has no area");
    frame.centroid = (frame.corners[0] + frame.corners[1] + frame.corners[2]) / 3;
    frame.normal = twice_area.normalized();
    frame.area = twice_area.norm() / 2;
    frame.radius = 0;
    for (const Eigen::Vector3d& corner : frame.corners) frame.radius += (corner - frame.centroid).norm() / 3;

    Eigen::Vector3d w = frame.normal;
    if (axis == Axis::inner_to_outer) {
      w = frame.centroid - (control.inner[t[0]] + control.inner[t[1]] + control.inner[t[2]]) / 3;
      if (!(std::abs(w.dot(frame.normal)) > kFlat * frame.radius))
        throw geometry::Refusal(geometry::refusal::kBadMesh, "the inner nodes of control triangle " +
                                                                 std::to_string(frames.size()) +
                                                                 " lie in the plane of its outer nodes");
    }
    const Eigen::Matrix3d plane = (Eigen::Matrix3d() << u, v, frame.normal).finished().inverse();
    frame.in_plane_from_offset = plane.topRows<2>();
    frame.local_from_offset = (Eigen::Matrix3d() << u, v, w).finished().inverse();
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace tensegric_fit::tffd
