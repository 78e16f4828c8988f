#include "reconstruction/surface_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel_for.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr int kFitRounds = 3;
constexpr int kFitNeighbours = 24;
constexpr int kRemembered =
    32;  // nearest points; they hold the neighbours of a vertex that has moved a little
constexpr double kFitReach = 2.5;          // bandwidths; points farther away do not count
constexpr double kLeastBandwidth = 0.003;  // m, of the Gaussian weight
constexpr double kMostBandwidth = 0.010;   // m
constexpr double kOfNeighbourhood = 0.4;   // bandwidth by the distance of the last neighbour
constexpr double kSameSide = 0.3;          // cosine between the normals of vertex and point
constexpr double kLargestStep = 0.003;     // m, in one round

/// Signed distance of `p` from the points' surface; 0 where no point counts. It is measured along the mean of
/// the normals here and at the point, which is square to the chord of a round surface: along the point's own
/// normal a finger would come out a millimetre too thick.
double distance_from_points(const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                            const geometry::PointCloud& cloud, const std::vector<int>& near) {
  const double bandwidth =
      std::clamp(kOfNeighbourhood * (p - cloud.points[near.back()]).norm(), kLeastBandwidth, kMostBandwidth);
  double weights = 0, sum = 0;
  for (int j : near) {
    const Eigen::Vector3d d = p - cloud.points[j];
    const double relative = d.squaredNorm() / (bandwidth * bandwidth);
    if (relative > kFitReach * kFitReach || cloud.normals[j].dot(normal) < kSameSide) continue;
    const double weight = std::exp(-relative / 2);
    weights += weight;
    sum += weight * (cloud.normals[j] + normal).dot(d) / 2;
  }
  return weights > 0 ? sum / weights : 0;
}

/// Nearest points of a vertex while it moves.
class Surroundings {
 public:
  /// Indices of the kFitNeighbours nearest, nearest first.
  void nearest(const geometry::PointTree& tree, const std::vector<Eigen::Vector3d>& points,
               const Eigen::Vector3d& p, std::vector<int>& near) {
    if (!still_nearest(points, p, near)) {
      tree.nearest(p, kRemembered, near);
      std::copy(near.begin(), near.end(), remembered_.begin());
      count_ = near.size();
      from_ = p;
      reach_ = (points[near.back()] - p).norm();
    }
    near.resize(std::min<std::size_t>(near.size(), kFitNeighbours));
  }

 private:
  /// True where no point but those remembered can be one of the nearest.
  bool still_nearest(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& p,
                     std::vector<int>& near) const {
    if (count_ < kRemembered) return false;
    std::array<std::pair<double, int>, kRemembered> by_distance;
    for (std::size_t i = 0; i < kRemembered; ++i)
      by_distance[i] = {(points[remembered_[i]] - p).squaredNorm(), remembered_[i]};
    std::sort(by_distance.begin(), by_distance.end());
    if (std::sqrt(by_distance[kFitNeighbours - 1].first) >= reach_ - (p - from_).norm()) return false;
    near.resize(kFitNeighbours);
    for (std::size_t i = 0; i < kFitNeighbours; ++i) near[i] = by_distance[i].second;
    return true;
  }

  std::array<int, kRemembered> remembered_;
  std::size_t count_ = 0;
  Eigen::Vector3d from_;
  double reach_;  // m, of the farthest that is remembered, from there
};

}  // namespace

void fit_to_points(geometry::TriangleMesh& mesh, const geometry::PointCloud& cloud,
                   const geometry::PointTree& tree) {
  std::vector<Surroundings> surroundings(mesh.vertices.size());
  for (int round = 0; round < kFitRounds; ++round) {
    const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
    geometry::parallel_for(mesh.vertices.size(), [&](std::size_t begin, std::size_t end, int) {
      std::vector<int> near;
      for (std::size_t v = begin; v < end; ++v) {
        surroundings[v].nearest(tree, cloud.points, mesh.vertices[v], near);
        const double distance = distance_from_points(mesh.vertices[v], normals[v], cloud, near);
        mesh.vertices[v] -= std::clamp(distance, -kLargestStep, kLargestStep) * normals[v];
      }
    });
  }
}

}  // namespace tensegric_fit::reconstruction
