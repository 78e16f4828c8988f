#include "booth/viewpoint_normals.hpp"

#include <Eigen/Eigenvalues>

#include "geometry/point_tree.hpp"

namespace tensegric_fit::booth {

std::vector<Eigen::Vector3d> viewpoint_normals(const std::vector<Eigen::Vector3d>& points,
                                               const Eigen::Vector3d& viewpoint) {
  constexpr int kNeighbours = 16;
  std::vector<Eigen::Vector3d> normals(points.size());
  if (points.empty()) return normals;
  const geometry::PointTree tree(points);
  std::vector<int> near;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    tree.nearest(points[i], kNeighbours, near);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (int j : near) {
      const Eigen::Vector3d d = points[j] - points[i];
      sum += d;
      products += d * d.transpose();
    }
    axes.computeDirect(products - sum * sum.transpose() / static_cast<double>(near.size()));
    const Eigen::Vector3d normal = axes.eigenvectors().col(0);
    normals[i] = normal.dot(viewpoint - points[i]) < 0 ? Eigen::Vector3d(-normal) : normal;
  }
  return normals;
}

}  // namespace tensegric_fit::booth
