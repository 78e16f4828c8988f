// t-FFD: binding, and evaluation on a whole body, of which the bust's control mesh carries some 2,000
// vertices, and on the chest's skin alone, every vertex of which it carries. Arguments are vertices, then the
// truncation in millionths.
#include <benchmark/benchmark.h>

#include "customer.hpp"
#include "tffd/body_volume.hpp"

namespace tensegric_fit::benchmarks {
namespace {

tffd::Options reference() {
  return {};
}

tffd::Options fast() {
  tffd::Options options;
  options.precision = tffd::Precision::fast;
  return options;
}

tffd::Options paper() {
  tffd::Options options;
  options.setting = tffd::Setting::paper;
  return options;
}

void bind(benchmark::State& state) {
  const geometry::TriangleMesh& mesh = body(2 * static_cast<int>(state.range(0)));
  const geometry::ControlMesh& control = bust_control(static_cast<int>(state.range(1)));
  std::size_t carried = 0;
  for (auto _ : state) carried = tffd::Binding(mesh, control, {}).anchors().size();
  state.counters["carried"] = static_cast<double>(carried);
}

double farthest(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, (a[i] - b[i]).norm());
  return distance;
}

void evaluate(benchmark::State& state, const geometry::TriangleMesh& mesh, const tffd::Options& options) {
  const geometry::ControlMesh& control = bust_control(120);
  const tensegric::Solution& s = worn(120, 0.90);
  const tffd::Binding binding(mesh, control, options);
  std::vector<Eigen::Vector3d> moved;
  for (auto _ : state) moved = binding.deform(s.outer, s.inner);
  const double carried = static_cast<double>(binding.anchors().size());
  state.counters["vertices"] = static_cast<double>(mesh.vertices.size());
  state.counters["carried"] = carried;
  if (options.setting == tffd::Setting::standard) {
    const auto exact = tffd::Binding(mesh, control, {}).deform(s.outer, s.inner);
    state.counters["entries_a_row"] = static_cast<double>(binding.weights().nodes.nonZeros()) / carried;
    state.counters["mm_off"] = 1e3 * farthest(moved, exact);
    const double nodes = std::max(farthest(s.outer, control.outer), farthest(s.inner, control.inner));
    state.counters["truncation_mm"] = 1e3 * binding.truncation_error() * nodes;  // bound
  }
}

void on_body(benchmark::State& state, tffd::Options (*options)()) {
  evaluate(state, body(2 * static_cast<int>(state.range(0))), options());
}

void on_chest_skin(benchmark::State& state, tffd::Options (*of_precision)()) {
  tffd::Options options = of_precision();
  options.truncation = 1e-6 * static_cast<double>(state.range(1));
  evaluate(state, chest_skin(2 * static_cast<int>(state.range(0))), options);
}

// The yardstick: the same M with every entry, as for weights without a reach such as mean value coordinates.
void dense(benchmark::State& state) {
  const geometry::ControlMesh& control = bust_control(120);
  const tensegric::Solution& s = worn(120, 0.90);
  const tffd::Binding binding(chest_skin(2 * static_cast<int>(state.range(0))), control, {});
  const Eigen::MatrixXd weights = binding.weights().nodes.toDense();
  Eigen::MatrixXd motion(weights.cols(), 3), moved;
  const auto outer = static_cast<Eigen::Index>(s.outer.size());
  for (Eigen::Index i = 0; i < outer; ++i) {
    motion.row(i) = (s.outer[i] - control.outer[i]).transpose();
    motion.row(outer + i) = (s.inner[i] - control.inner[i]).transpose();
  }
  for (auto _ : state) {
    moved.noalias() = weights * motion;
    benchmark::DoNotOptimize(moved.data());
  }
}

// As the solver asks for it: the body's volume under the bust, and its gradient by the control nodes.
void body_volume(benchmark::State& state) {
  const geometry::TriangleMesh& mesh = body(62000);
  const geometry::ControlMesh& control = bust_control(120);
  const tffd::Binding binding(mesh, control, {});
  const tffd::BodyVolume volume(binding, tffd::carried_triangles(binding, mesh.triangles, control)[0],
                                geometry::region_apex(control, control.regions[0]));
  std::vector<Eigen::Vector3d> nodes = worn(120, 0.90).outer, gradient;
  nodes.insert(nodes.end(), worn(120, 0.90).inner.begin(), worn(120, 0.90).inner.end());
  double after = 0;
  for (auto _ : state) after = volume(nodes, &gradient);
  state.counters["change_where_control_volume_is_kept"] = after / volume.at_rest() - 1;
}

BENCHMARK(bind)
    ->Args({31000, 120})
    ->Args({31000, 1920})
    ->Args({31000, 7680})
    ->Args({250000, 120})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(on_body, reference, &reference)->Arg(31000)->Arg(250000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(on_body, fast, &fast)->Arg(31000)->Arg(250000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(on_body, paper, &paper)->Arg(31000)->Unit(benchmark::kMillisecond);
void by_truncation(benchmark::internal::Benchmark* evaluation) {
  for (const int vertices : {31000, 250000})
    for (const int millionths : {0, 100, 1000, 10000, 100000}) evaluation->Args({vertices, millionths});
  evaluation->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(on_chest_skin, reference, &reference)->Apply(by_truncation);
BENCHMARK_CAPTURE(on_chest_skin, fast, &fast)->Apply(by_truncation);
BENCHMARK(dense)->Arg(31000)->Unit(benchmark::kMillisecond);
BENCHMARK(body_volume)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
