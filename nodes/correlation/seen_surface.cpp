#include "correlation/seen_surface.hpp"

#include "geometry/status.hpp"

namespace tensegric_fit::correlation {
namespace {

const geometry::TriangleMesh& checked(const geometry::TriangleMesh& mesh, const std::vector<char>& filled) {
  geometry::check_mesh(mesh);
  if (mesh.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the worn body has no triangles");
  if (!filled.empty() && filled.size() != mesh.vertices.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "filled holes need one flag per vertex");
  return mesh;
}

}  // namespace

SeenSurface::SeenSurface(const geometry::TriangleMesh& mesh, std::vector<char> filled)
    : mesh_(checked(mesh, filled)),
      filled_(std::move(filled)),
      normals_(geometry::vertex_normals(mesh.vertices, mesh.triangles)),
      tree_(mesh),
      border_(mesh) {}

SeenSurface::Place SeenSurface::nearest(const Eigen::Vector3d& query) const {
  const geometry::SurfacePoint point = tree_.nearest(query);
  Place place{point.position, Eigen::Vector3d::Zero(), !border_.holds(point)};
  for (int k = 0; k < 3; ++k) {
    const int vertex = mesh_.triangles[point.triangle][k];
    place.normal += point.barycentric[k] * normals_[vertex];
    place.seen = place.seen && (filled_.empty() || filled_[vertex] == 0);
  }
  const double length = place.normal.norm();
  if (length > 0) place.normal /= length;
  return place;
}

}  // namespace tensegric_fit::correlation
