// The four pictures that `fit` makes of a woman in a garment for bust and hips, from bodies to PNG files.
#include <benchmark/benchmark.h>

#include "customer.hpp"
#include "fit/chain.hpp"
#include "fit/picture_files.hpp"

namespace tensegric_fit::benchmarks {
namespace {

void pictures(benchmark::State& state) {
  fit::StageTimes times;
  const fit::Body body = fit::measure_scan(scan(180000), {}, times);
  std::vector<control_mesh::Template> patterns;
  for (const char* region : {"bust", "hips"})
    patterns.push_back(control_mesh::load_template(kLaunch + "/templates/" + region + ".yaml"));
  const fit::Fitting fitting = fit::prepare(body, patterns, {}, times);
  const fit::Fit worn =
      fit::wear(body, fitting, tensegric::take_garment("B2+H2", kLaunch + "/garments"), {}, times);
  std::size_t bytes = 0, files = 0;
  for (auto _ : state) {
    bytes = files = 0;
    for (const fit::PictureFile& picture : fit::pictures_of(body, fitting, worn, {}, {})) {
      bytes += picture.png.size();
      ++files;
    }
  }
  state.counters["files"] = static_cast<double>(files);
  state.counters["kilobytes"] = static_cast<double>(bytes) / 1000;
}

BENCHMARK(pictures)->Iterations(5)->Repetitions(5)->MeasureProcessCPUTime()->UseRealTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
