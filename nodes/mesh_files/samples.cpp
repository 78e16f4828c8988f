#include "mesh_files/samples.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

// Nearly every edge is passed once in each direction at most; a few spots where pieces touch do not count.
bool runs_alike(const TriangleMesh& mesh) {
  constexpr double kFew = 0.01;
  const std::vector<geometry::TriangleSide> sides = geometry::sorted_sides(mesh);
  std::size_t wrong = 0;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const auto &a = sides[i - 1], &b = sides[i];
    if (a.low != b.low || a.high != b.high) continue;
    if (a.forward == b.forward) ++wrong;
  }
  return static_cast<double>(wrong) <= kFew * static_cast<double>(sides.size());
}

TriangleMesh usable(const TriangleMesh& mesh) {
  TriangleMesh result{mesh.vertices, {}};
  const int count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (t.minCoeff() < 0 || t.maxCoeff() >= count)
      throw geometry::Refusal(geometry::refusal::kBadMesh, "a face has a vertex that is not there");
    if (mesh.vertices[t[0]].allFinite() && mesh.vertices[t[1]].allFinite() && mesh.vertices[t[2]].allFinite())
      result.triangles.push_back(t);
  }
  return result;
}

// Of a sequence that fills the square evenly (Roberts' R2: powers of 1 / the plastic number).
Eigen::Vector2d evenly(int i) {
  const auto share = [i](double step) { return std::fmod(0.5 + step * i, 1.0); };
  return {share(0.7548776662466927), share(0.5698402909980532)};
}

}  // namespace

geometry::PointCloud surface_samples(const TriangleMesh& given, int count) {
  const TriangleMesh mesh = usable(given);
  std::vector<Vector3d> areas;
  double whole = 0, volume = 0;
  Vector3d middle = Vector3d::Zero();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    areas.push_back(geometry::area_vector(a, b, c));
    whole += areas.back().norm();
    middle += areas.back().norm() / 3 * (a + b + c);
  }
  if (!(whole > 0)) throw geometry::Refusal(geometry::refusal::kBadMesh, "the mesh has no area");
  middle /= whole;
  for (std::size_t f = 0; f < areas.size(); ++f)
    volume += areas[f].dot(mesh.vertices[mesh.triangles[f][0]] - middle);
  const bool oriented = runs_alike(mesh);
  const double outward = volume < 0 ? -1 : 1;

  geometry::PointCloud cloud;
  double before = 0;  // area
  int made = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Eigen::Vector3i& t = mesh.triangles[f];
    const double area = areas[f].norm();
    before += area;
    for (; made < count && (made + 0.5) * whole <= before * count; ++made) {
      Eigen::Vector2d at = evenly(made);
      if (at.sum() > 1) at = Eigen::Vector2d::Ones() - at;
      const Vector3d& a = mesh.vertices[t[0]];
      cloud.points.push_back(a + at.x() * (mesh.vertices[t[1]] - a) + at.y() * (mesh.vertices[t[2]] - a));
      if (oriented) cloud.normals.push_back(outward / area * areas[f]);
    }
  }
  return cloud;
}

}  // namespace tensegric_fit::mesh_files
