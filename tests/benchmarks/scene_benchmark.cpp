// The chain from scan to first view for what a scene needs and no more, and from a change of garment to the
// new view. With listeners, every stage also makes what it shows to people.
#include <benchmark/benchmark.h>

#include <optional>

#include "customer.hpp"
#include "fit/chain.hpp"
#include "peak_memory.hpp"
#include "ros/display.hpp"
#include "ros/markers.hpp"

namespace tensegric_fit::benchmarks {
namespace {

struct Scene {
  std::vector<std::string> regions;  ///< none: measured only
  std::string garment;
  bool listeners = false;
};

struct View {
  fit::Body body;
  std::optional<fit::Fitting> fitting;
  fit::Fit worn;
};

tensegric::Garment garment_of(const Scene& scene) {
  return tensegric::take_garment(scene.garment, kLaunch + "/garments");
}

View first_view(const Scene& scene, fit::StageTimes& times) {
  View view;
  fit::Settings settings;
  settings.reconstruction.bust_only = scene.regions == std::vector<std::string>{"bust"};
  view.body = fit::measure_scan(scan(180000), settings, times);
  if (scene.regions.empty()) return view;
  std::vector<control_mesh::Template> patterns;
  for (const std::string& region : scene.regions)
    patterns.push_back(control_mesh::load_template(kLaunch + "/templates/" + region + ".yaml"));
  view.fitting = fit::prepare(view.body, patterns, {}, times);
  view.worn = fit::wear(view.body, *view.fitting, garment_of(scene), {}, times);
  return view;
}

// What reconstruction, landmarks, control_mesh, tensegric and tffd show, as their nodes make it.
void show(const View& view) {
  const std_msgs::Header header;
  const geometry::TriangleMesh& skin = view.body.mesh.mesh;
  const Eigen::Isometry3d& placed = view.body.measures.body_from_scan;
  const auto show_mesh = [&](const geometry::TriangleMesh& mesh, const std::vector<double>& distortion) {
    benchmark::DoNotOptimize(
        inspect::polygon_mesh(header, mesh, node::skin_colours(mesh, distortion, placed)));
    benchmark::DoNotOptimize(node::front_image(header, mesh, distortion, {}, placed));
  };
  const auto show_skin = [&](const geometry::TriangleMesh& mesh, const std::vector<double>& distortion) {
    const auto colours = node::skin_colours(mesh, distortion, placed);
    benchmark::DoNotOptimize(inspect::Markers(header).body(mesh, colours).share());
    show_mesh(mesh, distortion);
  };
  show_skin(skin, {});
  benchmark::DoNotOptimize(inspect::Markers(header).landmarks(view.body.measures).share());
  show_mesh(skin, {});
  if (!view.fitting) return;
  const geometry::ControlMesh& control = view.fitting->control;
  for (const auto* outer : {&control.outer, &view.worn.solution.outer}) {
    benchmark::DoNotOptimize(inspect::Markers(header).control_mesh(control, *outer).share());
    show_mesh({*outer, control.triangles}, {});
  }
  show_skin({view.worn.deformed, skin.triangles}, view.worn.distortion);
}

void scan_to_view(benchmark::State& state, const Scene& scene) {
  scan(180000);
  View view;
  fit::StageTimes times;
  const gauge::Growth growth;
  for (auto _ : state) {
    view = first_view(scene, times);
    if (scene.listeners) show(view);
  }
  state.counters["peak_mib"] = growth.mebibytes();
  const auto runs = static_cast<double>(state.iterations());
  for (const auto& [stage, milliseconds] : {std::pair("reconstruction", times.reconstruction),
                                            {"landmarks", times.landmarks},
                                            {"control_mesh", times.control_mesh},
                                            {"tensegric", times.tensegric},
                                            {"tffd", times.tffd}})
    state.counters[stage] = milliseconds / runs;
}

// The clerk's slider: the ratio moves by 0.01 on a body that is loaded, warm from the last balance.
void garment_change(benchmark::State& state) {
  fit::Settings settings;
  settings.control_mesh.control_triangles = static_cast<int>(state.range(0));
  fit::StageTimes times;
  static const fit::Body body = fit::measure_scan(scan(180000), {}, times);
  const auto pattern = control_mesh::load_template(kLaunch + "/templates/bust.yaml");
  const fit::Fitting fitting = fit::prepare(body, {pattern}, settings, times);
  const fit::Fit start = fit::wear(body, fitting, band(0.94), settings, times);
  const tensegric::Garment tighter = band(0.93);
  fit::Fit worn;
  for (auto _ : state) worn = fit::wear(body, fitting, tighter, settings, times, &start.solution);
  const auto& line = worn.solution.lines[0];
  const auto& region = worn.solution.regions[0];
  state.SetLabel(to_string(worn.solution.status));
  state.counters["line_error"] = line.final / line.neutral - 1;
  state.counters["control_volume_error"] = region.volume_after / region.volume_before - 1;
  state.counters["body_volume_error"] = worn.body_volumes_after[0] / worn.body_volumes_before[0] - 1;
}

void once(benchmark::internal::Benchmark* scene) {
  scene->Iterations(1)->Repetitions(3)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(scan_to_view, measure, Scene{})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, bust, Scene{{"bust"}, "B1"})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, hips, Scene{{"hips"}, "H1"})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, both, Scene{{"bust", "hips"}, "B1+H1"})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, measure_shown, Scene{{}, "", true})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, bust_shown, Scene{{"bust"}, "B1", true})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, hips_shown, Scene{{"hips"}, "H1", true})->Apply(once);
BENCHMARK_CAPTURE(scan_to_view, both_shown, Scene{{"bust", "hips"}, "B1+H1", true})->Apply(once);
BENCHMARK(garment_change)->Arg(120)->Arg(480)->Arg(1920)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
