#include "geometry/carried_points.hpp"

namespace tensegric_fit::geometry {

CarriedPoints::CarriedPoints(const TriangleMesh& rest, const SurfaceTree& skin,
                             const std::vector<Eigen::Vector3d>& points) {
  for (const Eigen::Vector3d& point : points) {
    const SurfacePoint nearest = skin.nearest(point);
    places_.push_back({rest.triangles[nearest.triangle], nearest.barycentric, point - nearest.position});
  }
}

std::vector<Eigen::Vector3d> CarriedPoints::at(const std::vector<Eigen::Vector3d>& vertices,
                                               double lift) const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(places_.size());
  for (const Place& place : places_) {
    Eigen::Vector3d point = place.offset;
    for (int corner = 0; corner < 3; ++corner)
      point += place.shares[corner] * vertices[place.corners[corner]];
    const auto corner = [&](int i) -> const Eigen::Vector3d& { return vertices[place.corners[i]]; };
    if (lift != 0) point += lift * area_vector(corner(0), corner(1), corner(2)).normalized();
    points.push_back(point);
  }
  return points;
}

}  // namespace tensegric_fit::geometry
