// Time of a solution beside how exact it is: cold (from rest to 0.90) and warm (0.91 to 0.90), by the number
// of control triangles.
#include <benchmark/benchmark.h>

#include "customer.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::benchmarks {
namespace {

using tensegric::SolverName;

tensegric::SolverOptions options_for(SolverName solver) {
  tensegric::SolverOptions options;
  options.solver = solver;
  return options;
}

void report(benchmark::State& state, const tensegric::Solution& s) {
  state.SetLabel(to_string(s.status));
  state.counters["iterations"] = s.iterations;
  state.counters["residual"] = s.residual;
  state.counters["line_error"] = s.lines[0].final / s.lines[0].neutral - 1;
  state.counters["volume_error"] = s.regions[0].volume_after / s.regions[0].volume_before - 1;
}

void cold(benchmark::State& state, SolverName solver) {
  const tensegric::Model& model = bust_model(static_cast<int>(state.range(0)));
  tensegric::Solution s;
  for (auto _ : state) s = tensegric::solve(model, chest_line(0.90), options_for(solver));
  report(state, s);
}

void warm(benchmark::State& state, SolverName solver) {
  const int triangles = static_cast<int>(state.range(0));
  const tensegric::Model& model = bust_model(triangles);
  const tensegric::Solution& start = worn(triangles, 0.91);
  tensegric::Solution s;
  for (auto _ : state) s = tensegric::solve(model, chest_line(0.90), options_for(solver), &start);
  report(state, s);
}

// A garment put on, to the deformed body of 62,000 triangles.
void solve_and_evaluate(benchmark::State& state, const tensegric::Solution* start) {
  const tensegric::Model& model = bust_model(120);
  const tffd::Binding binding(body(62000), bust_control(120), {});
  const tensegric::Garment garment = chest_line(0.90);
  tensegric::Solution s;
  for (auto _ : state) {
    s = tensegric::solve(model, garment, {}, start);
    benchmark::DoNotOptimize(binding.deform(s.outer, s.inner));
  }
  report(state, s);
}

void cold_to_body(benchmark::State& state) {
  solve_and_evaluate(state, nullptr);
}
void warm_to_body(benchmark::State& state) {
  solve_and_evaluate(state, &worn(120, 0.91));
}

BENCHMARK_CAPTURE(cold, equilibrium, SolverName::equilibrium)
    ->Arg(120)
    ->Arg(480)
    ->Arg(1920)
    ->Arg(7680)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(warm, equilibrium, SolverName::equilibrium)
    ->Arg(120)
    ->Arg(480)
    ->Arg(1920)
    ->Arg(7680)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cold, adaptive, SolverName::adaptive)->Arg(120)->Arg(480)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cold, relaxation, SolverName::relaxation)
    ->Arg(120)
    ->Arg(480)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(cold_to_body)->Unit(benchmark::kMillisecond);
BENCHMARK(warm_to_body)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
