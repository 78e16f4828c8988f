#include "geometry/oriented_tree.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "geometry/kd_tree.hpp"

namespace tensegric_fit::geometry {
namespace {

using Place = std::array<float, 6>;

/// Where a body stands far away, single precision would round by more than a scanner does: 0.06 mm at 1 km.
constexpr double kFar = 1000;  // m

/// What places are relative to.
Eigen::Vector3d origin_of(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d& first = points.front();
  return first.cwiseAbs().maxCoeff() > kFar ? first : Eigen::Vector3d::Zero();
}

Place place_of(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, float reach) {
  const Eigen::Vector3f p = point.cast<float>(), n = reach * normal.cast<float>();
  return {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
}

std::vector<Place> places_of(const std::vector<Eigen::Vector3d>& points,
                             const std::vector<Eigen::Vector3d>& normals, float reach) {
  const Eigen::Vector3d origin = origin_of(points);
  std::vector<Place> places;
  places.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    places.push_back(place_of(points[i] - origin, normals[i], reach));
  return places;
}

}  // namespace

struct OrientedTree::Tree : KdTree<Place, float, 6> {
  Tree(const std::vector<Eigen::Vector3d>& at, const std::vector<Eigen::Vector3d>& normals, float r)
      : KdTree(places_of(at, normals, r)), origin(origin_of(at)), reach(r) {}

  std::pair<int, float> nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    return KdTree::nearest(place_of(point - origin, normal, reach).data());
  }

  Eigen::Vector3d origin;
  float reach;
};

OrientedTree::OrientedTree(const std::vector<Eigen::Vector3d>& points,
                           const std::vector<Eigen::Vector3d>& normals, double reach)
    : tree_(std::make_unique<Tree>(points, normals, static_cast<float>(reach))) {}

OrientedTree::~OrientedTree() = default;

int OrientedTree::nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  return tree_->nearest(point, normal).first;
}

double OrientedTree::distance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  return std::sqrt(tree_->nearest(point, normal).second);
}

}  // namespace tensegric_fit::geometry
