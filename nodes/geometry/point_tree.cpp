#include "geometry/point_tree.hpp"

#include <cmath>

#include "geometry/kd_tree.hpp"

namespace tensegric_fit::geometry {

struct PointTree::Tree : KdTree<Eigen::Vector3d, double, 3> {
  using KdTree::KdTree;
};

namespace {

double squared_up(double radius) {
  return std::nextafter(radius * radius, HUGE_VAL);
}  // `radius` is within

/// nanoflann's result set of points that are visited, none kept.
struct Visits {
  double squared;  // of the radius
  const std::vector<int>& order;
  const void* visit;
  double (*call)(const void* visit, int index);

  std::size_t size() const { return 0; }
  bool full() const { return false; }
  double worstDist() const { return squared; }
  bool addPoint(double distance, int place) {
    if (distance >= squared) return true;  // the radius has shrunk within a leaf
    const double radius = call(visit, order[place]);
    squared = radius < 0 ? 0 : squared_up(radius);
    return radius >= 0;
  }
};

}  // namespace

PointTree::PointTree(const std::vector<Eigen::Vector3d>& points) : tree_(std::make_unique<Tree>(points)) {}

PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;
PointTree::~PointTree() = default;

double PointTree::distance(const Eigen::Vector3d& query) const {
  return std::sqrt(tree_->nearest(query.data()).second);
}

int PointTree::nearest(const Eigen::Vector3d& query) const {
  return tree_->nearest(query.data()).first;
}

void PointTree::nearest(const Eigen::Vector3d& query, int count, std::vector<int>& indices) const {
  indices.resize(count);
  thread_local std::vector<double> squared;
  squared.resize(count);
  indices.resize(tree_->index.knnSearch(query.data(), count, indices.data(), squared.data()));
  for (int& i : indices) i = tree_->order[i];
}

void PointTree::visit_within(const Eigen::Vector3d& query, double radius, const void* visit,
                             double (*call)(const void* visit, int index)) const {
  Visits visits{squared_up(radius), tree_->order, visit, call};
  tree_->index.radiusSearchCustomCallback(query.data(), visits);
}

const std::vector<int>& PointTree::order() const {
  return tree_->order;
}

}  // namespace tensegric_fit::geometry
