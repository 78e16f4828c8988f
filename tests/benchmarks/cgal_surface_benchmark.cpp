// Yardsticks of the reconstruction by CGAL: Poisson (Kazhdan et al. 2006 over a Delaunay refinement) and
// advancing front (Cohen-Steiner and Da 2004). CGAL's packages for this are GPL: no part of the product.
#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/poisson_surface_reconstruction.h>

#include "peak_memory.hpp"
#include "surface_yardstick.hpp"

namespace tensegric_fit::benchmarks {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Oriented = std::pair<Point, Kernel::Vector_3>;
using Mesh = CGAL::Surface_mesh<Point>;

void cgal_poisson(benchmark::State& state) {
  const geometry::PointCloud& cloud = oriented_points();
  std::vector<Oriented> points;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d &p = cloud.points[i], &n = cloud.normals[i];
    points.emplace_back(Point(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  const CGAL::First_of_pair_property_map<Oriented> point_map{};
  const CGAL::Second_of_pair_property_map<Oriented> normal_map{};
  Mesh surface;
  bool done = true;
  const gauge::Growth growth;
  for (auto _ : state) {
    surface.clear();
    const double spacing = CGAL::compute_average_spacing<CGAL::Sequential_tag>(
        points, 6, CGAL::parameters::point_map(point_map));
    done = CGAL::poisson_surface_reconstruction_delaunay(points.begin(), points.end(), point_map, normal_map,
                                                         surface, spacing);
  }
  if (!done) return state.SkipWithError("no surface");
  state.counters["peak_mib"] = growth.mebibytes();
  geometry::TriangleMesh mesh;
  for (const auto v : surface.vertices()) {
    const Point& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : surface.faces()) {
    Eigen::Vector3i corners;
    int k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(face)))
      corners[k++] = static_cast<int>(v.idx());
    mesh.triangles.push_back(corners);
  }
  report_yardstick(state, mesh);
}

void cgal_advancing_front(benchmark::State& state) {
  const geometry::PointCloud& cloud = oriented_points();
  std::vector<Point> points;
  for (const Eigen::Vector3d& p : cloud.points) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> facets;
  const gauge::Growth growth;
  for (auto _ : state) {
    facets.clear();
    CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(), std::back_inserter(facets));
  }
  state.counters["peak_mib"] = growth.mebibytes();
  geometry::TriangleMesh mesh;
  mesh.vertices = cloud.points;
  for (const auto& facet : facets)
    mesh.triangles.emplace_back(static_cast<int>(facet[0]), static_cast<int>(facet[1]),
                                static_cast<int>(facet[2]));
  report_yardstick(state, mesh);
}

BENCHMARK(cgal_poisson)
    ->Iterations(1)
    ->Repetitions(1)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(cgal_advancing_front)
    ->Iterations(1)
    ->Repetitions(3)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
