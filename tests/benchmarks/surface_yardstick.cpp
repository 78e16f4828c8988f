#include "surface_yardstick.hpp"

#include "geometry/status.hpp"
#include "reconstruction/body_points.hpp"
#include "reconstruction/normals.hpp"
#include "reconstruction/support.hpp"

namespace tensegric_fit::benchmarks {
namespace {

bool closed(const geometry::TriangleMesh& mesh) {
  try {
    return geometry::is_closed(mesh);
  } catch (const geometry::Refusal&) {
    return false;  // not even a manifold
  }
}

}  // namespace

const geometry::PointCloud& oriented_points() {
  static const geometry::PointCloud cloud = [] {
    const geometry::PointCloud& all = scan(180000);
    geometry::PointCloud body;
    for (const int i : reconstruction::body_points(all.points, [](const auto&) { return true; }))
      body.points.push_back(all.points[i]);
    body.normals = reconstruction::outward_normals(body.points, {});
    return body;
  }();
  return cloud;
}

void report_surface(benchmark::State& state, const geometry::TriangleMesh& mesh,
                    const std::vector<char>& filled) {
  const auto off = gauge::distances(mesh.vertices, filled, customer().mesh);
  state.counters["truth_median_mm"] = 1e3 * gauge::quantile(off, 0.5);
  state.counters["truth_p95_mm"] = 1e3 * gauge::quantile(off, 0.95);
  state.counters["truth_p99_mm"] = 1e3 * gauge::quantile(off, 0.99);
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  state.counters["closed"] = closed(mesh);
}

void report_yardstick(benchmark::State& state, const geometry::TriangleMesh& mesh) {
  report_surface(state, mesh,
                 reconstruction::filled_vertices(mesh, geometry::PointTree(oriented_points().points),
                                                 oriented_points().points.size(),
                                                 reconstruction::Options().support_distance));
}

}  // namespace tensegric_fit::benchmarks
