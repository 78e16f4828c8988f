// The yardstick: as-rigid-as-possible deformation (Sorkine and Alexa 2007) by CGAL, on the same body of
// 62,000 triangles and the same region. CGAL's mesh packages are GPL: no part of the product.
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <limits>

#include "customer.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::benchmarks {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Deformation = CGAL::Surface_mesh_deformation<Mesh>;
using Vertex = Mesh::Vertex_index;

Mesh cgal_mesh(const geometry::TriangleMesh& mesh) {
  Mesh result;
  for (const Eigen::Vector3d& p : mesh.vertices) result.add_vertex({p.x(), p.y(), p.z()});
  for (const Eigen::Vector3i& t : mesh.triangles)
    result.add_face(Vertex(static_cast<unsigned>(t[0])), Vertex(static_cast<unsigned>(t[1])),
                    Vertex(static_cast<unsigned>(t[2])));
  return result;
}

int nearest(const Eigen::Vector3d& q, const tffd::Binding& binding) {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const tffd::Anchor& anchor : binding.anchors()) {
    const double distance = (binding.vertices()[anchor.vertex] - q).squaredNorm();
    if (distance < least) least = distance, best = anchor.vertex;
  }
  return best;
}

enum class Interest { body, region };

// The vertices at the line's nodes go where our fit puts them; the skin that the control mesh does not carry
// stays. CGAL's region of interest is the whole body, or only what the control mesh carries and its edge.
// Timed are the ten iterations alone, not the factorisation before them.
void arap(benchmark::State& state, Interest interest) {
  const geometry::TriangleMesh& mesh = body(62000);
  const tffd::Binding binding(mesh, bust_control(120), {});
  const tensegric::Solution& s = worn(120, 0.90);
  const std::vector<Eigen::Vector3d> fitted = binding.deform(s.outer, s.inner);
  Mesh deformed = cgal_mesh(mesh);
  Deformation deformation(deformed);

  const auto neighbours = geometry::neighbours_of(mesh.vertices.size(), mesh.triangles);
  std::vector<int> handles;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    const bool carried = binding.reaches(v);
    const bool edge = !carried && std::any_of(neighbours[v].begin(), neighbours[v].end(),
                                              [&](int next) { return binding.reaches(next); });
    if (interest == Interest::region && !carried && !edge) continue;
    deformation.insert_roi_vertex(Vertex(static_cast<unsigned>(v)));
    if (!carried) deformation.insert_control_vertex(Vertex(static_cast<unsigned>(v)));
  }
  for (const int node : s.lines[0].nodes) {
    const int vertex = nearest(bust_control(120).outer[node], binding);
    if (deformation.insert_control_vertex(Vertex(static_cast<unsigned>(vertex)))) handles.push_back(vertex);
  }
  if (!deformation.preprocess()) return state.SkipWithError("the region has too few handles");
  for (auto _ : state) {
    state.PauseTiming();
    deformation.reset();
    for (const int v : handles)
      deformation.set_target_position(Vertex(static_cast<unsigned>(v)),
                                      {fitted[v].x(), fitted[v].y(), fitted[v].z()});
    state.ResumeTiming();
    deformation.deform(10, 0);
  }

  std::vector<Eigen::Vector3d> after;
  for (const Vertex v : deformed.vertices()) {
    const auto& p = deformed.point(v);
    after.emplace_back(p.x(), p.y(), p.z());
  }
  state.counters["region"] = static_cast<double>(deformation.roi_vertices().size());
  state.counters["handles"] = static_cast<double>(handles.size());
  state.counters["body_volume_error"] =
      geometry::cone_volume(after, mesh.triangles) / geometry::cone_volume(mesh.vertices, mesh.triangles) - 1;
}

BENCHMARK_CAPTURE(arap, body, Interest::body)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(arap, region, Interest::region)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
