#include "geometry/surface_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/nearest_on_sides.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector3d;

Vector3d centroid(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
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

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : mesh_(mesh) {
  struct Alike {
    double reach = 0;
    std::vector<int> triangles;
    std::vector<Vector3d> centroids;
  };
  std::map<int, Alike> by_octave;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    const Vector3d centre = centroid(mesh, t);
    double reach = 0;
    for (int k = 0; k < 3; ++k) reach = std::max(reach, (mesh.vertices[t[k]] - centre).norm());
    Alike& alike = by_octave[std::ilogb(std::max(reach, std::numeric_limits<double>::min()))];
    alike.reach = std::max(alike.reach, reach);
    alike.triangles.push_back(static_cast<int>(i));
    alike.centroids.push_back(centre);
  }
  for (auto& [octave, alike] : by_octave)
    sizes_.push_back({alike.reach, std::move(alike.triangles), PointTree(alike.centroids)});
  // Most of a mesh first: what is found there rules out nearly all of the rest.
  std::stable_sort(sizes_.begin(), sizes_.end(),
                   [](const Size& a, const Size& b) { return a.triangles.size() > b.triangles.size(); });
}

SurfacePoint SurfaceTree::nearest(const Vector3d& query) const {
  SurfacePoint best{-1, Vector3d::Zero(), Vector3d::Zero()};
  double least = std::numeric_limits<double>::infinity(), least_to_centroid = least;
  for (const Size& size : sizes_)
    size.centroids.visit_within(query, least + size.reach, [&](int i) {
      const int t = size.triangles[i];
      const Eigen::Vector3i& k = mesh_.triangles[t];
      const std::array<Vector3d, 3> corners{mesh_.vertices[k[0]], mesh_.vertices[k[1]], mesh_.vertices[k[2]]};
      const Vector3d at = nearest_in(corners, query);
      const Vector3d position = at[0] * corners[0] + at[1] * corners[1] + at[2] * corners[2];
      const double distance = (position - query).norm();
      const double to_centroid = ((corners[0] + corners[1] + corners[2]) / 3 - query).norm();
      if (distance < least || (distance == least && to_centroid < least_to_centroid)) {
        best = {t, at, position};
        least = distance;
        least_to_centroid = to_centroid;
      }
      return least + size.reach;
    });
  return best;
}

}  // namespace tensegric_fit::geometry
