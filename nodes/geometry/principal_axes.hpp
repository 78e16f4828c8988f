/// Principal axes of a few neighbouring points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <vector>

namespace tensegric_fit::geometry {

/// Axes through the mean of the points `near`, in columns of eigenvectors(): first the unit normal of their
/// least-squares plane, its sign arbitrary. eigenvalues(): sums of the squared distances along them, m^2.
/// Numerically best if `origin` is close to the points.
inline Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal_axes(
    const std::vector<Eigen::Vector3d>& points, const std::vector<int>& near, const Eigen::Vector3d& origin) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const int j : near) {
    const Eigen::Vector3d d = points[j] - origin;
    sum += d;
    products += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(products - sum * sum.transpose() / static_cast<double>(near.size()));
  return axes;
}

}  // namespace tensegric_fit::geometry
