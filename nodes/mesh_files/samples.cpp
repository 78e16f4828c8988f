#include "mesh_files/samples.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

// Every edge is passed once in each direction at most.
bool runs_alike(const TriangleMesh& mesh) {
  const std::vector<geometry::TriangleSide> sides = geometry::sorted_sides(mesh);
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i - 1].low == sides[i].low && sides[i - 1].high == sides[i].high &&
        sides[i - 1].forward == sides[i].forward)
      return false;
  return true;
}

// For each piece of the mesh, 1, or -1 where its triangles run clockwise from outside, by its volume about
// its middle.
std::vector<double> outside_of(const TriangleMesh& mesh, const std::vector<int>& piece,
                               const std::vector<Vector3d>& areas) {
  const int count = piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end()) + 1;
  std::vector<double> area(count, 0), volume(count, 0);
  std::vector<Vector3d> middle(count, Vector3d::Zero());
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Eigen::Vector3i& t = mesh.triangles[f];
    area[piece[f]] += areas[f].norm();
    middle[piece[f]] +=
        areas[f].norm() / 3 * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
  }
  for (std::size_t f = 0; f < areas.size(); ++f)
    volume[piece[f]] += areas[f].dot(mesh.vertices[mesh.triangles[f][0]] - middle[piece[f]] / area[piece[f]]);
  std::vector<double> outside;
  for (const double v : volume) outside.push_back(v < 0 ? -1 : 1);
  return outside;
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
  double whole = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    areas.push_back(geometry::area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
    whole += areas.back().norm();
  }
  if (!(whole > 0)) throw geometry::Refusal(geometry::refusal::kBadMesh, "the mesh has no area");
  const bool oriented = runs_alike(mesh);
  const std::vector<int> piece = geometry::components_of(mesh);
  const std::vector<double> outside = outside_of(mesh, piece, areas);

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
      if (oriented) cloud.normals.push_back(outside[piece[f]] / area * areas[f]);
    }
  }
  return cloud;
}

}  // namespace tensegric_fit::mesh_files
