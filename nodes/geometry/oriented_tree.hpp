/// Nearest oriented points: place and direction together.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace tensegric_fit::geometry {

/// A kd-tree over (point, reach * normal): a normal that is turned by 60 degrees counts like `reach` metres:
/// skin of the other side of an arm is farther than kReach.
class OrientedTree {
 public:
  static constexpr double kReach = 0.05;  ///< m
  /// \pre not empty, of one size, all finite
  OrientedTree(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& normals,
               double reach = kReach);
  ~OrientedTree();
  /// Index of the nearest.
  int nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

  /// m, to it, in both.
  double distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace tensegric_fit::geometry
