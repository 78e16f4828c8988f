#include "geometry/surface_tree.hpp"

#include "geometry/nearest_on_sides.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;
constexpr int kCandidates = 24;

std::vector<Vector3d> centroids_of(const TriangleMesh& mesh) {
  std::vector<Vector3d> centroids;
  centroids.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    centroids.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  return centroids;
}

// Barycentric coordinates of the triangle's point nearest to `q`.
Vector3d nearest_in(const std::array<Vector3d, 3>& corners, const Vector3d& q) {
  const Vector3d normal = area_vector(corners[0], corners[1], corners[2]);
  const double squared = normal.squaredNorm();
  Vector3d inside = Vector3d::Constant(-1);
  if (squared > 0)
    for (int k = 0; k < 3; ++k)
      inside[k] = normal.dot(area_vector(q, corners[(k + 1) % 3], corners[(k + 2) % 3])) / squared;
  return inside.minCoeff() >= 0 ? inside : nearest_on_sides(corners, inside, q);
}

}  // namespace

SurfaceTree::SurfaceTree(const TriangleMesh& mesh)
    : mesh_(mesh), centroids_(centroids_of(mesh)), tree_(centroids_) {}

SurfacePoint SurfaceTree::nearest(const Vector3d& query) const {
  std::vector<int> near;
  tree_.nearest(query, kCandidates, near);
  SurfacePoint best{-1, Vector3d::Zero(), Vector3d::Zero()};
  for (const int t : near) {
    const Eigen::Vector3i& k = mesh_.triangles[t];
    const std::array<Vector3d, 3> corners{mesh_.vertices[k[0]], mesh_.vertices[k[1]], mesh_.vertices[k[2]]};
    const Vector3d at = nearest_in(corners, query);
    const Vector3d position = at[0] * corners[0] + at[1] * corners[1] + at[2] * corners[2];
    if (best.triangle < 0 || (position - query).norm() < (best.position - query).norm())
      best = {t, at, position};
  }
  return best;
}

}  // namespace tensegric_fit::geometry
