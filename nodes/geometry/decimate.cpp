#include "geometry/decimate.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <limits>
#include <queue>
#include <tuple>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Mesh to_open_mesh(const TriangleMesh& mesh) {
  Mesh result;
  result.reserve(mesh.vertices.size(), 3 * mesh.triangles.size() / 2, mesh.triangles.size());
  for (const Eigen::Vector3d& v : mesh.vertices) result.add_vertex({v.x(), v.y(), v.z()});
  for (const Eigen::Vector3i& t : mesh.triangles)
    if (!result.add_face(Mesh::VertexHandle(t[0]), Mesh::VertexHandle(t[1]), Mesh::VertexHandle(t[2]))
             .is_valid())
      throw Refusal(refusal::kBadMesh, "the mesh is not manifold: surfaces meet in one edge or vertex");
  return result;
}

TriangleMesh from_open_mesh(const Mesh& mesh) {
  TriangleMesh result;
  for (const auto v : mesh.vertices())
    result.vertices.emplace_back(mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2]);
  for (const auto face : mesh.faces()) {
    Eigen::Vector3i t;
    int k = 0;
    for (const auto v : face.vertices()) t[k++] = v.idx();
    result.triangles.push_back(t);
  }
  return result;
}

void collapse_to(Mesh& mesh, std::size_t triangles) {
  mesh.request_face_normals();
  mesh.update_face_normals();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
  decimater.add(quadric);
  decimater.module(quadric).unset_max_err();
  decimater.add(flipping);
  decimater.module(flipping).set_max_normal_deviation(60);
  decimater.initialize();
  decimater.decimate_to_faces(0, triangles);
  mesh.garbage_collection();
}

// Splits the longest edges first, of those whose midpoint is between two heights.
void split_to(Mesh& mesh, std::size_t triangles, double lowest, double highest) {
  using Entry = std::tuple<double, int>;  // squared length, negated edge index: ties go to the lower index
  std::priority_queue<Entry> longest;
  const auto push = [&](Mesh::EdgeHandle e) {
    const double height = mesh.calc_edge_midpoint(e)[2];
    if (height >= lowest && height <= highest) longest.emplace(mesh.calc_edge_sqr_length(e), -e.idx());
  };
  for (const auto e : mesh.edges()) push(e);
  while (mesh.n_faces() + 2 <= triangles && !longest.empty()) {
    const auto [squared, number] = longest.top();
    longest.pop();
    const Mesh::EdgeHandle edge(-number);
    if (mesh.calc_edge_sqr_length(edge) != squared) continue;  // it has been split since it was queued
    const Mesh::VertexHandle middle = mesh.add_vertex(mesh.calc_edge_midpoint(edge));
    mesh.split(edge, middle);
    for (const auto e : mesh.ve_range(middle)) push(e);
  }
}

/// True where no remaining triangle turns by 60 degrees or more.
bool keeps_facing(const Mesh& mesh, Mesh::HalfedgeHandle collapse) {
  constexpr double kCosine = 0.5;
  const OpenMesh::Vec3d from = mesh.point(mesh.from_vertex_handle(collapse)),
                        to = mesh.point(mesh.to_vertex_handle(collapse));
  for (const auto side : mesh.voh_range(mesh.from_vertex_handle(collapse))) {
    const Mesh::VertexHandle a = mesh.to_vertex_handle(side),
                             b = mesh.to_vertex_handle(mesh.next_halfedge_handle(side));
    if (mesh.to_vertex_handle(collapse) == a || mesh.to_vertex_handle(collapse) == b) continue;
    const OpenMesh::Vec3d across = mesh.point(b) - mesh.point(a);
    const OpenMesh::Vec3d before = (mesh.point(a) - from) % across, after = (mesh.point(a) - to) % across;
    if ((before | after) <= kCosine * before.norm() * after.norm()) return false;
  }
  return true;
}

}  // namespace

TriangleMesh with_triangles(const TriangleMesh& mesh, int triangles) {
  Mesh work = to_open_mesh(mesh);
  const auto wanted = static_cast<std::size_t>(triangles);
  if (work.n_faces() > wanted) collapse_to(work, wanted);
  split_to(work, wanted, -kInfinity, kInfinity);
  return from_open_mesh(work);
}

TriangleMesh with_finer_belt(const TriangleMesh& mesh, int triangles, double lowest, double highest) {
  Mesh work = to_open_mesh(mesh);
  split_to(work, static_cast<std::size_t>(triangles), lowest, highest);
  return from_open_mesh(work);
}

TriangleMesh without_short_edges(const TriangleMesh& mesh, double shortest) {
  Mesh work = to_open_mesh(mesh);
  work.request_face_status();
  work.request_edge_status();
  work.request_vertex_status();
  for (const auto edge : work.edges()) {
    if (work.status(edge).deleted() || work.calc_edge_sqr_length(edge) >= shortest * shortest) continue;
    for (const int way : {0, 1}) {
      const Mesh::HalfedgeHandle collapse = work.halfedge_handle(edge, way);
      const Mesh::VertexHandle goes = work.from_vertex_handle(collapse),
                               stays = work.to_vertex_handle(collapse);
      if (work.status(goes).locked() || work.is_boundary(goes) || !work.is_collapse_ok(collapse) ||
          !keeps_facing(work, collapse))
        continue;
      work.collapse(collapse);
      work.status(stays).set_locked(
          true);  // else a whole row of vertices would be collapsed one after the other
      break;
    }
  }
  work.garbage_collection();
  return from_open_mesh(work);
}

}  // namespace tensegric_fit::geometry
