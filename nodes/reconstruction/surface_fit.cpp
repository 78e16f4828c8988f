#include "reconstruction/surface_fit.hpp"

#include <algorithm>
#include <cmath>

#include "reconstruction/neighbours.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr int kRounds = 3;
constexpr int kNeighbours = 24;
constexpr double kReach = 0.008;        // m; points farther away do not count
constexpr double kBandwidth = 0.003;    // m; of the Gaussian weight
constexpr double kSameSide = 0.3;       // cosine between the normals of vertex and point
constexpr double kLargestStep = 0.003;  // m, in one round

/// Signed distance of `p` from the points' surface; 0 where no point counts.
double distance_from_points(const Eigen::Vector3d& p, const Eigen::Vector3d& normal,
                            const geometry::PointCloud& cloud, const std::vector<int>& near) {
  double weights = 0, sum = 0;
  for (int j : near) {
    const Eigen::Vector3d d = p - cloud.points[j];
    const double squared = d.squaredNorm();
    if (squared > kReach * kReach || cloud.normals[j].dot(normal) < kSameSide) continue;
    const double weight = std::exp(-squared / (2 * kBandwidth * kBandwidth));
    weights += weight;
    sum += weight * cloud.normals[j].dot(d);
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace

void fit_to_points(geometry::TriangleMesh& mesh, const geometry::PointCloud& cloud) {
  const PointTree tree(cloud.points);
  std::vector<int> near;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      tree.nearest(mesh.vertices[v], kNeighbours, near);
      const double distance = distance_from_points(mesh.vertices[v], normals[v], cloud, near);
      mesh.vertices[v] -= std::clamp(distance, -kLargestStep, kLargestStep) * normals[v];
    }
  }
}

}  // namespace tensegric_fit::reconstruction
