// The chain on a virtual body: time from scan to first view and of a change of garment, beside the errors to
// truth.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "booth/virtual_body.hpp"
#include "booth/virtual_scanner.hpp"
#include "fit/chain.hpp"

namespace {

using namespace tensegric_fit;

const std::string kLaunch = TENSEGRIC_FIT_LAUNCH;

struct Customer {
  booth::VirtualBody truth = booth::make_body({});
  geometry::PointCloud scan = booth::scan_body(truth.mesh, {}).cloud;
};

const Customer& customer() {
  static const Customer one;
  return one;
}

tensegric::Garment b1(double ratio) {
  tensegric::Garment garment = tensegric::load_garment(kLaunch + "/garments/B1.yaml");
  garment.lines[0].ratio = ratio;
  return garment;
}

void report_fit(benchmark::State& state, const fit::Fit& worn) {
  const auto& line = worn.solution.lines[0];
  const auto& region = worn.solution.regions[0];
  state.SetLabel(to_string(worn.solution.status));
  state.counters["line_error"] = line.final / line.neutral - 1;
  state.counters["control_volume_error"] = region.volume_after / region.volume_before - 1;
  state.counters["body_volume_error"] = worn.body_volumes_after[0] / worn.body_volumes_before[0] - 1;
}

// Largest error of the large girths, mm.
double girth_error(const geometry::BodyMeasures& measured, const geometry::BodyMeasures& truth) {
  double worst = 0;
  for (const char* name : {"bust", "underbust", "waist", "hip"}) {
    const auto girth = [name](const geometry::BodyMeasures& m) {
      const auto found =
          std::find_if(m.girths.begin(), m.girths.end(), [&](const auto& g) { return g.name == name; });
      return found == m.girths.end() ? NAN : found->metres;
    };
    worst = std::max(worst, 1e3 * std::abs(girth(measured) - girth(truth)));
  }
  return worst;
}

void scan_to_first_view(benchmark::State& state) {
  const auto pattern = control_mesh::load_template(kLaunch + "/templates/bust.yaml");
  const Customer& c = customer();
  fit::Body body;
  fit::Fit worn;
  for (auto _ : state) {
    fit::StageTimes times;
    body = fit::measure_scan(c.scan, {}, times);
    worn = fit::wear(body, fit::prepare(body, {pattern}, {}, times), b1(0.9), {}, times);
  }
  report_fit(state, worn);
  state.counters["points"] = static_cast<double>(c.scan.points.size());
  state.counters["girth_error_mm"] = girth_error(body.measures, c.truth.truth);
}

// The clerk's slider: the ratio moves by 0.01 on a body that is loaded, warm from the last balance.
void garment_change(benchmark::State& state) {
  fit::Settings settings;
  settings.control_mesh.control_triangles = static_cast<int>(state.range(0));
  fit::StageTimes times;
  static const fit::Body body = fit::measure_scan(customer().scan, {}, times);
  const auto pattern = control_mesh::load_template(kLaunch + "/templates/bust.yaml");
  const fit::Fitting fitting = fit::prepare(body, {pattern}, settings, times);
  const fit::Fit start = fit::wear(body, fitting, b1(0.94), settings, times);
  const tensegric::Garment tighter = b1(0.93);
  fit::Fit worn;
  for (auto _ : state) worn = fit::wear(body, fitting, tighter, settings, times, &start.solution);
  report_fit(state, worn);
}

BENCHMARK(scan_to_first_view)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(garment_change)->Arg(120)->Arg(480)->Arg(1920)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
