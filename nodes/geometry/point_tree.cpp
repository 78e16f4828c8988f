#include "geometry/point_tree.hpp"

#include <cmath>
#include <nanoflann.hpp>

#include "geometry/leaf_order.hpp"

namespace tensegric_fit::geometry {

struct PointTree::Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 3, int>;

  std::vector<Eigen::Vector3d> points;
  std::vector<int> order;
  Index index;

  explicit Tree(const std::vector<Eigen::Vector3d>& p) : points(p), index(3, *this) {
    index.buildIndex();
    order = to_leaf_order(index, points);
  }

  // What nanoflann asks of a data set.
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

namespace {

/// nanoflann's result set of one point at most: the first within the radius for which the test holds.
struct First {
  double squared;  // of the radius
  const std::vector<int>& order;
  const void* test;
  bool (*holds)(const void* test, int index);
  bool found = false;

  std::size_t size() const { return found ? 1 : 0; }
  bool full() const { return found; }
  double worstDist() const { return squared; }
  bool addPoint(double, int place) {
    found = holds(test, order[place]);
    return !found;
  }
};

}  // namespace

PointTree::PointTree(const std::vector<Eigen::Vector3d>& points) : tree_(std::make_unique<Tree>(points)) {}

PointTree::~PointTree() = default;

double PointTree::distance(const Eigen::Vector3d& query) const {
  int index;
  double squared = 0;
  tree_->index.knnSearch(query.data(), 1, &index, &squared);
  return std::sqrt(squared);
}

int PointTree::nearest(const Eigen::Vector3d& query) const {
  int index;
  double squared;
  tree_->index.knnSearch(query.data(), 1, &index, &squared);
  return tree_->order[index];
}

void PointTree::nearest(const Eigen::Vector3d& query, int count, std::vector<int>& indices) const {
  indices.resize(count);
  thread_local std::vector<double> squared;
  squared.resize(count);
  indices.resize(tree_->index.knnSearch(query.data(), count, indices.data(), squared.data()));
  for (int& i : indices) i = tree_->order[i];
}

bool PointTree::any_within(const Eigen::Vector3d& query, double radius, const void* test,
                           bool (*holds)(const void* test, int index)) const {
  First first{std::nextafter(radius * radius, HUGE_VAL), tree_->order, test, holds};  // `radius` is within
  return tree_->index.radiusSearchCustomCallback(query.data(), first) > 0;
}

const std::vector<int>& PointTree::order() const {
  return tree_->order;
}

}  // namespace tensegric_fit::geometry
