/// What the trees of this package share of nanoflann. For .cpp files: headers do without nanoflann.
#pragma once

#include <cstddef>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

static_assert(NANOFLANN_VERSION >= 0x142, "earlier constructors may not build the tree");

/// A kd-tree over `points`, arrays of kAxes coordinates. They are stored in the order of its leaves, those of
/// a leaf beside each other; the index says places in that order. \pre not empty, all finite
template <typename Point, typename Scalar, int kAxes>
struct KdTree {
  using Index =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<Scalar, KdTree>, KdTree, kAxes, int>;

  std::vector<Point> points;
  std::vector<int> order;  ///< former index of each point
  Index index;

  explicit KdTree(std::vector<Point> unordered) : points(std::move(unordered)), index(kAxes, *this) {
    order = index.vAcc;  // nanoflann's constructor has built the tree
    std::vector<Point> ordered;
    ordered.reserve(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      ordered.push_back(points[order[i]]);
      index.vAcc[i] = static_cast<int>(i);
    }
    points = std::move(ordered);
  }
  KdTree(const KdTree&) = delete;  // the index refers to it
  KdTree& operator=(const KdTree&) = delete;

  /// Former index of the nearest point, and the square of its distance.
  std::pair<int, Scalar> nearest(const Scalar* query) const {
    int place = 0;
    Scalar squared = 0;
    index.knnSearch(query, 1, &place, &squared);
    return {order[place], squared};
  }

  // What nanoflann asks of a data set.
  std::size_t kdtree_get_point_count() const { return points.size(); }
  Scalar kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

}  // namespace tensegric_fit::geometry
