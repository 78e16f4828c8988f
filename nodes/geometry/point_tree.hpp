/// Nearest neighbours of points.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace tensegric_fit::geometry {

/// A kd-tree over points, which must outlive it.
class PointTree {
 public:
  /// \pre not empty, all finite
  explicit PointTree(const std::vector<Eigen::Vector3d>& points);
  ~PointTree();

  /// Distance from `query` to the nearest point.
  double distance(const Eigen::Vector3d& query) const;
  /// Index of the nearest point.
  int nearest(const Eigen::Vector3d& query) const;
  /// Indices of the `count` nearest points, nearest first; fewer where there are fewer points.
  void nearest(const Eigen::Vector3d& query, int count, std::vector<int>& indices) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace tensegric_fit::geometry
