#include "reconstruction/normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>

#include "geometry/parallel_for.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/principal_axes.hpp"
#include "reconstruction/visibility.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr int kPlaneNeighbours = 16;  // of the plane through a point's surroundings
constexpr int kLinks = 8;             // nearest neighbours whose signs are linked

// Share of the normals that were given, by how clearly the points are seen. It is 0.002 to 0.007 where they
// are right (four meshes, a scan), 0.05 where her chest alone is inside out, 0.4 where they are signed for
// the scan's origin.
constexpr double kContradicted = 0.03;

struct Link {
  float agreement;  // |n_a . n_b|
  int a, b;
};

bool more_certain(const Link& l, const Link& r) {
  return std::tie(r.agreement, l.a, l.b) < std::tie(l.agreement, r.a, r.b);
}

/// Unsigned normals of the points from `begin` to `end` in the tree's order, and links from each to its
/// nearest neighbours.
void plane_normals(const std::vector<Eigen::Vector3d>& points, const geometry::PointTree& tree,
                   std::size_t begin, std::size_t end, std::vector<Eigen::Vector3d>& normals,
                   std::vector<Link>& links) {
  std::vector<int> near;
  for (std::size_t at = begin; at < end; ++at) {
    const int i = tree.order()[at];
    tree.nearest(points[i], kPlaneNeighbours, near);
    normals[i] = geometry::principal_axes(points, near, points[near.front()]).eigenvectors().col(0);
    for (int k = 0; k < std::min<int>(kLinks + 1, static_cast<int>(near.size())); ++k)
      if (near[k] > i || k == kLinks) links.push_back({0, i, near[k]});
  }
}

/// Patches of points whose normals are known relative to each other, each with the evidence for its sign.
class SignedPatches {
 public:
  explicit SignedPatches(std::vector<double> evidence)
      : parent_(evidence.size()), flipped_(evidence.size(), 0), evidence_(std::move(evidence)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// Joins the patches of a and b, whose normals point the same way (or not), unless both know better.
  void join(int a, int b, bool same_way) {
    const auto [root_a, flip_a] = find(a);
    const auto [root_b, flip_b] = find(b);
    if (root_a == root_b) return;
    const bool flip = (flip_a != flip_b) == same_way;  // of root b's normal against root a's
    const double from_b = flip ? -evidence_[root_b] : evidence_[root_b];
    if (evidence_[root_a] * from_b < 0 && std::min(std::abs(evidence_[root_a]), std::abs(from_b)) > kSure)
      return;
    const int root = std::min(root_a, root_b), child = std::max(root_a, root_b);
    const double joined = evidence_[root_a] + from_b;
    evidence_[root] = root == root_a || !flip ? joined : -joined;
    parent_[child] = root;
    flipped_[child] = flip;
  }

  /// True where the normal of i must be turned over.
  bool turned(int i) {
    const auto [root, flip] = find(i);
    return flip != (evidence_[root] < 0);
  }

 private:
  static constexpr double kSure = 20;  // evidence, in points seen full face

  std::pair<int, bool> find(int i) {
    bool flip = false;
    int root = i;
    for (; parent_[root] != root; root = parent_[root]) flip ^= flipped_[root];
    for (bool rest = flip; parent_[i] != root && i != root;) {  // the path now ends at the root
      const int next = parent_[i];
      const bool of_next = rest ^ flipped_[i];
      parent_[i] = root;
      flipped_[i] = rest;
      rest = of_next;
      i = next;
    }
    return {root, flip};
  }

  std::vector<int> parent_;
  std::vector<char> flipped_;  // against the parent
  std::vector<double> evidence_;
};

/// Directions out of the body, whatever was given: some clouds of a scan may have normals, and others none.
std::vector<Eigen::Vector3d> outward_hints(const std::vector<Eigen::Vector3d>& points,
                                           const std::vector<Eigen::Vector3d>& hints) {
  std::vector<Eigen::Vector3d> outwards = seen_from(points);
  for (Eigen::Vector3d& direction : outwards) direction /= std::max(1.0, direction.norm());
  double agree = 0, contradict = 0;
  for (std::size_t i = 0; i < hints.size(); ++i) {
    const double product = hints[i].dot(outwards[i]);
    (product > 0 ? agree : contradict) += std::abs(product);
  }
  // Signed for another viewpoint, or not at all: what is seen says more.
  if (std::min(agree, contradict) > kContradicted * (agree + contradict)) return outwards;
  const double sign = agree < contradict ? -1 : 1;  // made for a viewpoint within the body, say
  for (std::size_t i = 0; i < hints.size(); ++i)
    if (!hints[i].isZero(0)) outwards[i] = sign * hints[i];
  return outwards;
}

}  // namespace

std::vector<Eigen::Vector3d> outward_normals(const std::vector<Eigen::Vector3d>& points,
                                             const std::vector<Eigen::Vector3d>& hints, bool outward) {
  const geometry::PointTree tree(points);
  std::vector<Eigen::Vector3d> normals(points.size());
  std::array<std::vector<Link>, 2> links_of_half;
  geometry::parallel_for(points.size(), [&](std::size_t begin, std::size_t end, int half) {
    plane_normals(points, tree, begin, end, normals, links_of_half[half]);
  });
  geometry::parallel_for(2, [&](std::size_t, std::size_t, int half) {
    for (Link& link : links_of_half[half])
      link.agreement = static_cast<float>(std::abs(normals[link.a].dot(normals[link.b])));
    std::sort(links_of_half[half].begin(), links_of_half[half].end(), more_certain);
  });
  std::vector<Link> links;
  links.reserve(links_of_half[0].size() + links_of_half[1].size());
  std::merge(links_of_half[0].begin(), links_of_half[0].end(), links_of_half[1].begin(),
             links_of_half[1].end(), std::back_inserter(links), more_certain);

  const std::vector<Eigen::Vector3d> outwards = outward ? hints : outward_hints(points, hints);
  std::vector<double> evidence(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) evidence[i] = outwards[i].dot(normals[i]);
  SignedPatches patches(evidence);
  for (const Link& link : links) patches.join(link.a, link.b, normals[link.a].dot(normals[link.b]) > 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (patches.turned(static_cast<int>(i))) normals[i] = -normals[i];
  return normals;
}

}  // namespace tensegric_fit::reconstruction
