#include "body_model/oriented_tree.hpp"

#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "geometry/leaf_order.hpp"

namespace tensegric_fit::body_model {

struct OrientedTree::Tree {
  using Place = std::array<float, 6>;
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Tree>, Tree, 6, int>;

  std::vector<Place> places;
  std::vector<int> order;
  float reach;
  std::unique_ptr<Index> index;

  void build() {
    index = std::make_unique<Index>(6, *this);
    index->buildIndex();
    order = geometry::to_leaf_order(*index, places);
  }

  Place place(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    const Eigen::Vector3f p = point.cast<float>(), n = reach * normal.cast<float>();
    return {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
  }

  // What nanoflann asks of a data set.
  std::size_t kdtree_get_point_count() const { return places.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return places[i][axis]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

OrientedTree::OrientedTree(const std::vector<Eigen::Vector3d>& points,
                           const std::vector<Eigen::Vector3d>& normals, double reach)
    : tree_(std::make_unique<Tree>()) {
  tree_->reach = static_cast<float>(reach);
  tree_->places.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    tree_->places.push_back(tree_->place(points[i], normals[i]));
  tree_->build();
}

OrientedTree::~OrientedTree() = default;

int OrientedTree::nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  const Tree::Place query = tree_->place(point, normal);
  int index = 0;
  float squared = 0;
  tree_->index->knnSearch(query.data(), 1, &index, &squared);
  return tree_->order[index];
}

double OrientedTree::distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  const Tree::Place query = tree_->place(point, normal);
  int index = 0;
  float squared = 0;
  tree_->index->knnSearch(query.data(), 1, &index, &squared);
  return std::sqrt(squared);
}

}  // namespace tensegric_fit::body_model
