#include "geometry/point_tree.hpp"

#include <cmath>
#include <nanoflann.hpp>

namespace tensegric_fit::geometry {

struct PointTree::Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 3, int>;

  const std::vector<Eigen::Vector3d>& points;
  Index index;

  explicit Tree(const std::vector<Eigen::Vector3d>& p) : points(p), index(3, *this) {}

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

PointTree::PointTree(const std::vector<Eigen::Vector3d>& points) : tree_(std::make_unique<Tree>(points)) {
  tree_->index.buildIndex();
}

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
  return index;
}

void PointTree::nearest(const Eigen::Vector3d& query, int count, std::vector<int>& indices) const {
  indices.resize(count);
  std::vector<double> squared(count);
  indices.resize(tree_->index.knnSearch(query.data(), count, indices.data(), squared.data()));
}

}  // namespace tensegric_fit::geometry
