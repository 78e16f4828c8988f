#include "assembler/viewpoint_normals.hpp"

#include "geometry/local_plane.hpp"
#include "geometry/point_tree.hpp"

namespace tensegric_fit::assembler {

std::vector<Eigen::Vector3d> viewpoint_normals(const std::vector<Eigen::Vector3d>& points,
                                               const Eigen::Vector3d& viewpoint) {
  constexpr int kNeighbours = 16;
  std::vector<Eigen::Vector3d> normals(points.size());
  if (points.empty()) return normals;
  const geometry::PointTree tree(points);
  std::vector<int> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.nearest(points[i], kNeighbours, near);
    const Eigen::Vector3d normal = geometry::local_plane(points, near).normal;
    normals[i] = normal.dot(viewpoint - points[i]) < 0 ? Eigen::Vector3d(-normal) : normal;
  }
  return normals;
}

}  // namespace tensegric_fit::assembler
