#include "geometry/oriented_tree.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "geometry/kd_tree.hpp"

namespace tensegric_fit::geometry {
namespace {

using Place = std::array<float, 6>;

Place place_of(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, float reach) {
  const Eigen::Vector3f p = point.cast<float>(), n = reach * normal.cast<float>();
  return {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
}

std::vector<Place> places_of(const std::vector<Eigen::Vector3d>& points,
                             const std::vector<Eigen::Vector3d>& normals, float reach) {
  std::vector<Place> places;
  places.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) places.push_back(place_of(points[i], normals[i], reach));
  return places;
}

}  // namespace

struct OrientedTree::Tree : KdTree<Place, float, 6> {
  Tree(std::vector<Place> places, float r) : KdTree(std::move(places)), reach(r) {}
  float reach;
};

OrientedTree::OrientedTree(const std::vector<Eigen::Vector3d>& points,
                           const std::vector<Eigen::Vector3d>& normals, double reach)
    : tree_(std::make_unique<Tree>(places_of(points, normals, static_cast<float>(reach)),
                                   static_cast<float>(reach))) {}

OrientedTree::~OrientedTree() = default;

int OrientedTree::nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  return tree_->nearest(place_of(point, normal, tree_->reach).data()).first;
}

double OrientedTree::distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  return std::sqrt(tree_->nearest(place_of(point, normal, tree_->reach).data()).second);
}

}  // namespace tensegric_fit::geometry
