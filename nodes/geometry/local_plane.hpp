/// The plane of a few neighbouring points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <vector>

namespace tensegric_fit::geometry {

/// Least-squares plane through the mean of the points. Numerically best if the first of `near` is close to
/// the others.
struct LocalPlane {
  Eigen::Vector3d normal;  ///< unit, sign arbitrary
  double squares;          ///< sum of squared distances of the points from the plane, m^2
};

inline LocalPlane local_plane(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& near) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const int j : near) {
    const Eigen::Vector3d d = points[j] - points[near.front()];
    sum += d;
    products += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(products - sum * sum.transpose() / static_cast<double>(near.size()));
  return {axes.eigenvectors().col(0), axes.eigenvalues()[0]};
}

}  // namespace tensegric_fit::geometry
