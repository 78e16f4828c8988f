// Time of a solution beside how exact it is, by the number of control triangles: cold (from rest to 0.90) and
// warm (0.91 to 0.90); and by the iterations after which it is stopped.
#include <benchmark/benchmark.h>

#include <cmath>

#include "customer.hpp"
#include "peak_memory.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::benchmarks {
namespace {

using tensegric::SolverName;

constexpr int kFinest = 7680;

tensegric::SolverOptions options_for(SolverName solver) {
  tensegric::SolverOptions options;
  options.solver = solver;
  return options;
}

void report(benchmark::State& state, const tensegric::Solution& s) {
  state.SetLabel(to_string(s.status));
  state.counters["steps"] = s.iterations;
  state.counters["residual"] = s.residual;
  state.counters["line_error"] = s.lines[0].final / s.lines[0].neutral - 1;
  state.counters["volume_error"] = s.regions[0].volume_after / s.regions[0].volume_before - 1;
}

// How far the body lies from where the finest control mesh takes it.
void compare_with_finest(benchmark::State& state, const tensegric::Solution& s, int control_triangles) {
  const auto worn_body = [](const tensegric::Solution& solution, int triangles) {
    return tffd::Binding(body(62000), bust_control(triangles), {}).deform(solution.outer, solution.inner);
  };
  static const std::vector<Eigen::Vector3d> finest = worn_body(worn(kFinest, 0.90), kFinest);
  const std::vector<Eigen::Vector3d> is = worn_body(s, control_triangles);
  double largest = 0, sum = 0, moved = 0;
  for (std::size_t v = 0; v < is.size(); ++v) {
    const double off = (is[v] - finest[v]).norm();
    largest = std::max(largest, off);
    sum += off * off;
    moved += finest[v] != body(62000).vertices[v];
  }
  state.counters["to_finest_rms_mm"] = 1e3 * std::sqrt(sum / moved);
  state.counters["to_finest_max_mm"] = 1e3 * largest;
}

void cold(benchmark::State& state, SolverName solver) {
  const int triangles = static_cast<int>(state.range(0));
  const tensegric::Model& model = bust_model(triangles);
  tensegric::Solution s;
  const gauge::Growth growth;
  for (auto _ : state) s = tensegric::solve(model, chest_line(0.90), options_for(solver));
  state.counters["peak_mib"] = growth.mebibytes();
  report(state, s);
  compare_with_finest(state, s, triangles);
}

// Stopped after so many iterations, on 120 control triangles: how far the nodes are from the balance.
void stopped(benchmark::State& state, SolverName solver) {
  tensegric::SolverOptions options = options_for(solver);
  options.max_iterations = static_cast<int>(state.range(0));
  tensegric::Solution s;
  for (auto _ : state) s = tensegric::solve(bust_model(120), chest_line(0.90), options);
  report(state, s);
  const tensegric::Solution& balance = worn(120, 0.90);
  double largest = 0;
  for (std::size_t i = 0; i < s.outer.size(); ++i)
    largest = std::max(largest, (s.outer[i] - balance.outer[i]).norm());
  state.counters["from_balance_mm"] = 1e3 * largest;
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

void by_control_triangles(benchmark::internal::Benchmark* solving) {
  solving->Arg(60)->Arg(120)->Arg(480)->Arg(1920)->Unit(benchmark::kMillisecond);
}

// Of the finest control mesh seconds, not tenths of them: fewer runs.
void finest(benchmark::internal::Benchmark* solving) {
  solving->Arg(kFinest)->Iterations(1)->Repetitions(3)->Unit(benchmark::kMillisecond);
}

void by_iterations(benchmark::internal::Benchmark* solving) {
  for (const int most : {1, 2, 3, 4, 6, 8, 12, 30, 100, 300, 1000}) solving->Arg(most);
  solving->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(cold, equilibrium, SolverName::equilibrium)->Apply(by_control_triangles);
BENCHMARK_CAPTURE(cold, equilibrium, SolverName::equilibrium)->Apply(finest);
BENCHMARK_CAPTURE(warm, equilibrium, SolverName::equilibrium)->Apply(by_control_triangles);
BENCHMARK_CAPTURE(warm, equilibrium, SolverName::equilibrium)->Apply(finest);
BENCHMARK_CAPTURE(cold, adaptive, SolverName::adaptive)->Arg(120)->Arg(480)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cold, relaxation, SolverName::relaxation)
    ->Arg(120)
    ->Arg(480)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(stopped, equilibrium, SolverName::equilibrium)->Apply(by_iterations);
BENCHMARK_CAPTURE(stopped, adaptive, SolverName::adaptive)->Apply(by_iterations);
BENCHMARK_CAPTURE(stopped, relaxation, SolverName::relaxation)->Apply(by_iterations);
BENCHMARK(cold_to_body)->Unit(benchmark::kMillisecond);
BENCHMARK(warm_to_body)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tensegric_fit::benchmarks
