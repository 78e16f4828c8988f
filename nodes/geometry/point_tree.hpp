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
  PointTree(PointTree&& other) noexcept;
  PointTree& operator=(PointTree&& other) noexcept;
  ~PointTree();

  /// Distance from `query` to the nearest point.
  double distance(const Eigen::Vector3d& query) const;
  /// Index of the nearest point.
  int nearest(const Eigen::Vector3d& query) const;
  /// Indices of the `count` nearest points, nearest first; fewer where there are fewer points.
  void nearest(const Eigen::Vector3d& query, int count, std::vector<int>& indices) const;
  /// Calls `visit(index)` for points within a radius of `query`, m: first `radius`, then what the last call
  /// returned, which may only shrink; negative: no more.
  template <typename Visit>
  void visit_within(const Eigen::Vector3d& query, double radius, const Visit& visit) const {
    visit_within(query, radius, &visit,
                 [](const void* v, int index) { return (*static_cast<const Visit*>(v))(index); });
  }
  /// Whether `test(index)` holds for any point within `radius` of `query`; asks no further than the first.
  template <typename Test>
  bool any_within(const Eigen::Vector3d& query, double radius, const Test& test) const {
    bool found = false;
    visit_within(query, radius, [&](int index) {
      found = test(index);
      return found ? -1 : radius;
    });
    return found;
  }
  /// All indices, those of points beside each other mostly close together: looking for the neighbours of many
  /// points is quicker in this order.
  const std::vector<int>& order() const;

 private:
  void visit_within(const Eigen::Vector3d& query, double radius, const void* visit,
                    double (*call)(const void* visit, int index)) const;

  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace tensegric_fit::geometry
