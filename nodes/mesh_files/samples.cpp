#include "mesh_files/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/order_of_place.hpp"
#include "geometry/status.hpp"
#include "mesh_files/pieces.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

/// The pieces that a surface falls into, and how their triangles are to be turned to run alike, outwards.
struct Sides {
  std::vector<double> turn;  // of each triangle, 1 or -1
  bool known = false;        // on most of the surface
};

Sides sides_of(const TriangleMesh& mesh, const std::vector<Vector3d>& areas) {
  constexpr double kSolid = 1e-3;  // volume over area to the power 1.5; of a ball 0.09, of a sheet 0
  Pieces pieces(mesh);
  std::vector<double> area(areas.size(), 0), volume(areas.size(), 0);  // of each piece, at its first triangle
  std::vector<Vector3d> middle(areas.size(), Vector3d::Zero());
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Eigen::Vector3i& t = mesh.triangles[f];
    const int piece = pieces.root(static_cast<int>(f));
    area[piece] += areas[f].norm();
    middle[piece] += areas[f].norm() / 3 * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]);
  }
  Sides result;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const int piece = pieces.root(static_cast<int>(f));
    result.turn.push_back(pieces.is_against(static_cast<int>(f)) ? -1 : 1);
    if (area[piece] > 0)
      volume[piece] += result.turn[f] / 3 *
                       areas[f].dot(mesh.vertices[mesh.triangles[f][0]] - middle[piece] / area[piece]);
  }
  double whole = 0, solid = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const int piece = pieces.root(static_cast<int>(f));
    if (volume[piece] < 0) result.turn[f] = -result.turn[f];
    whole += areas[f].norm();
    if (std::abs(volume[piece]) >= kSolid * std::pow(area[piece], 1.5)) solid += areas[f].norm();
  }
  result.known = pieces.have_two_sides() && 2 * solid >= whole;
  return result;
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

// One triangle of those with the same corners.
TriangleMesh without_repeated(const TriangleMesh& mesh) {
  std::vector<std::array<int, 4>> corners;  // ascending, and the triangle
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    std::array<int, 3> of{mesh.triangles[f][0], mesh.triangles[f][1], mesh.triangles[f][2]};
    std::sort(of.begin(), of.end());
    corners.push_back({of[0], of[1], of[2], static_cast<int>(f)});
  }
  std::sort(corners.begin(), corners.end());
  std::vector<char> keep(mesh.triangles.size(), 1);
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (std::equal(corners[i].begin(), corners[i].begin() + 3, corners[i - 1].begin()))
      keep[corners[i][3]] = 0;
  TriangleMesh result{mesh.vertices, {}};
  for (std::size_t f = 0; f < keep.size(); ++f)
    if (keep[f]) result.triangles.push_back(mesh.triangles[f]);
  return result;
}

// Of a sequence that fills the square evenly (Roberts' R2: powers of 1 / the plastic number).
Eigen::Vector2d evenly(int i) {
  const auto share = [i](double step) { return std::fmod(0.5 + step * i, 1.0); };
  return {share(0.7548776662466927), share(0.5698402909980532)};
}

}  // namespace

geometry::PointCloud surface_samples(const TriangleMesh& mesh, int count) {
  TriangleMesh cleaned = without_repeated(usable(mesh));
  cleaned.triangles = geometry::in_order_of_place(cleaned);
  std::vector<Vector3d> areas;
  double whole = 0;
  for (const Eigen::Vector3i& t : cleaned.triangles) {
    areas.push_back(
        geometry::area_vector(cleaned.vertices[t[0]], cleaned.vertices[t[1]], cleaned.vertices[t[2]]));
    whole += areas.back().norm();
  }
  if (!(whole > 0)) throw geometry::Refusal(geometry::refusal::kBadMesh, "the mesh has no area");
  const Sides sides = sides_of(cleaned, areas);

  geometry::PointCloud cloud;
  double before = 0;  // area
  int made = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Eigen::Vector3i& t = cleaned.triangles[f];
    const double area = areas[f].norm();
    before += area;
    for (; made < count && (made + 0.5) * whole <= before * count; ++made) {
      Eigen::Vector2d at = evenly(made);
      if (at.sum() > 1) at = Eigen::Vector2d::Ones() - at;
      const Vector3d& a = cleaned.vertices[t[0]];
      cloud.points.push_back(a + at.x() * (cleaned.vertices[t[1]] - a) +
                             at.y() * (cleaned.vertices[t[2]] - a));
      if (sides.known) cloud.normals.push_back(sides.turn[f] / area * areas[f]);
    }
  }
  return cloud;
}

}  // namespace tensegric_fit::mesh_files
