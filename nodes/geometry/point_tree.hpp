/// Nearest neighbours of points.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace tensegric_fit::geometry {

/// A kd-tree over a copy of points.
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
  /// Whether `test(index)` holds for any point within `radius` of `query`; asks no further than the first.
  template <typename Test>
  bool any_within(const Eigen::Vector3d& query, double radius, const Test& test) const {
    return any_within(query, radius, &test,
                      [](const void* t, int index) { return (*static_cast<const Test*>(t))(index); });
  }
  /// All indices, those of points beside each other mostly close together: looking for the neighbours of many
  /// points is quicker in this order.
  const std::vector<int>& order() const;

 private:
  bool any_within(const Eigen::Vector3d& query, double radius, const void* test,
                  bool (*holds)(const void* test, int index)) const;

  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace tensegric_fit::geometry
