// Reconstruction: time and memory beside how far the body mesh is from the true skin, and what that makes of
// the body's measures. Beside it PCL's Poisson reconstruction as it comes.
#include <benchmark/benchmark.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>

#include "fit/chain.hpp"
#include "peak_memory.hpp"
#include "surface_yardstick.hpp"

namespace tensegric_fit::benchmarks {
namespace {

constexpr int kPoints = 180000;  // of one scan

struct Setting {
  int points = kPoints;
  reconstruction::Options options = {};
};

fit::Body measured(const Setting& setting) {
  fit::Settings settings;
  settings.reconstruction = setting.options;
  fit::StageTimes times;
  return fit::measure_scan(scan(setting.points), settings, times);
}

// The skin of the finest setting of a sweep, made where it was not timed before.
const geometry::TriangleMesh& skin_of(const Setting& setting, const fit::Body* made = nullptr) {
  static std::map<std::tuple<int, int, int>, geometry::TriangleMesh> all;
  const auto key =
      std::make_tuple(setting.points, setting.options.poisson_depth, setting.options.body_triangles);
  auto found = all.find(key);
  if (found == all.end())
    found = all.emplace(key, made ? made->mesh.mesh : measured(setting).mesh.mesh).first;
  return found->second;
}

// Largest error of the measures that have those names, mm; NaN where one of them was not found.
double largest_error(const std::vector<geometry::Measure>& found, const std::vector<geometry::Measure>& truth,
                     const std::vector<std::string>& names) {
  const auto value = [](const std::vector<geometry::Measure>& measures, const std::string& name) {
    for (const geometry::Measure& measure : measures)
      if (measure.name == name) return measure.metres;
    return std::numeric_limits<double>::quiet_NaN();
  };
  double largest = 0;
  for (const std::string& name : names) {
    const double off = 1e3 * std::abs(value(found, name) - value(truth, name));
    if (!std::isfinite(off)) return off;  // std::max would drop it
    largest = std::max(largest, off);
  }
  return largest;
}

void report(benchmark::State& state, const fit::Body& body, const Setting& finest) {
  const auto off = gauge::distances(body.mesh.mesh.vertices, body.mesh.filled, skin_of(finest));
  state.counters["finest_median_mm"] = 1e3 * gauge::quantile(off, 0.5);
  state.counters["finest_p95_mm"] = 1e3 * gauge::quantile(off, 0.95);
  report_surface(state, body.mesh.mesh, body.mesh.filled);
  const geometry::BodyMeasures& truth = customer().truth;
  if (truth.girths.empty()) return;
  state.counters["girth_mm"] =
      largest_error(body.measures.girths, truth.girths, {"bust", "underbust", "waist", "hip"});
  state.counters["height_mm"] =
      largest_error(body.measures.heights, truth.heights, {"bust", "underbust", "waist", "hip", "stature"});
}

// Timed is the reconstruction, with the registration of the body model.
void reconstruct(benchmark::State& state, const Setting& setting, const Setting& finest) {
  const geometry::PointCloud& seen = scan(setting.points);
  fit::Body body;
  const gauge::Growth growth;
  const body_model::Registrar& registrar = body_model::shipped_registrar();
  for (auto _ : state) {
    reconstruction::Reconstruction made =
        reconstruction::reconstruct(seen, setting.options, {std::cref(registrar), registrar.standing()});
    body.mesh = std::move(made.body);
    body.model = std::move(made.model);
  }
  state.counters["peak_mib"] = growth.mebibytes();
  body.measures = landmarks::find_landmarks(body.mesh.mesh, body.mesh.filled, *body.model,
                                            landmarks::shipped_precision());
  skin_of(setting, &body);
  report(state, body, finest);
}

void by_depth(benchmark::State& state) {
  Setting setting, finest;
  setting.options.poisson_depth = static_cast<int>(state.range(0));
  finest.options.poisson_depth = 10;
  reconstruct(state, setting, finest);
}

void by_points(benchmark::State& state) {
  Setting setting, finest;
  setting.points = static_cast<int>(state.range(0));
  finest.points = 720000;
  reconstruct(state, setting, finest);
}

void by_triangles(benchmark::State& state) {
  Setting setting, finest;
  setting.options.body_triangles = static_cast<int>(state.range(0));
  finest.options.body_triangles = 250000;
  reconstruct(state, setting, finest);
}

// As it comes: our normals are given to it, and what it leaves is taken as it is.
void pcl_poisson(benchmark::State& state) {
  const geometry::PointCloud& cloud = oriented_points();
  const auto input = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f p = cloud.points[i].cast<float>(), n = cloud.normals[i].cast<float>();
    input->emplace_back(p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
  }
  pcl::PolygonMesh surface;
  const gauge::Growth growth;
  for (auto _ : state) {
    pcl::Poisson<pcl::PointNormal> poisson;
    poisson.setDepth(static_cast<int>(state.range(0)));
    poisson.setThreads(1);
    poisson.setInputCloud(input);
    poisson.reconstruct(surface);
  }
  state.counters["peak_mib"] = growth.mebibytes();
  geometry::TriangleMesh mesh;
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(surface.cloud, vertices);
  for (const pcl::PointXYZ& v : vertices) mesh.vertices.emplace_back(v.x, v.y, v.z);
  for (const pcl::Vertices& face : surface.polygons)
    mesh.triangles.emplace_back(static_cast<int>(face.vertices[0]), static_cast<int>(face.vertices[1]),
                                static_cast<int>(face.vertices[2]));
  report_yardstick(state, mesh);
}

// The finest first: the others are compared with it.
void once_for_each(benchmark::internal::Benchmark* sweep, const std::vector<int>& values) {
  for (const int value : values) sweep->Arg(value);
  sweep->Iterations(1)->Repetitions(3)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(by_depth)->Apply([](auto* sweep) { once_for_each(sweep, {10, 9, 8, 7, 6}); });
BENCHMARK(by_points)->Apply([](auto* sweep) {
  once_for_each(sweep, {720000, 360000, 180000, 90000, 40000, 20000});
});
BENCHMARK(by_triangles)->Apply([](auto* sweep) {
  once_for_each(sweep, {250000, 125000, 62000, 31000, 16000, 8000});
});
BENCHMARK(pcl_poisson)->Apply([](auto* sweep) { once_for_each(sweep, {8, 9}); });

}  // namespace
}  // namespace tensegric_fit::benchmarks
