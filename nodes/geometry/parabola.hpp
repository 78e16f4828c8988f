/// The parabola of least squares through places on a line.
#pragma once

#include <Eigen/Core>

namespace tensegric_fit::geometry {

/// y = c[0] + c[1] x + c[2] x^2. Numerically best where x is about 1 at most.
class Parabola {
 public:
  void add(double x, double y) {
    const Eigen::Vector3d terms(1, x, x * x);
    squares_ += terms * terms.transpose();
    sums_ += y * terms;
    ++count_;
  }
  int count() const { return count_; }
  /// c. \pre at least three different x
  Eigen::Vector3d coefficients() const;

 private:
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums_ = Eigen::Vector3d::Zero();
  int count_ = 0;
};

}  // namespace tensegric_fit::geometry
