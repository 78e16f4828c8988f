// Time of a solution beside how exact it is: the three solvers, cold and warm, on 120, 480 and 1920 control
// triangles.
#include <benchmark/benchmark.h>

#include "../unit/tensegric_bust.hpp"
#include "tensegric/solver.hpp"

namespace {

using namespace tensegric_fit::tensegric;

Model bust(int refinement) {
  BustShape shape;
  shape.columns *= refinement;
  shape.rows *= refinement;
  auto control = bust_mesh(shape);
  for (std::size_t i = 0; i < control.outer.size(); ++i)  // half as thick, so that fine prisms stay upright
    control.inner[i] = (control.inner[i] + control.outer[i]) / 2;
  return build_model(control, {});
}

Garment chest(double ratio) {
  Garment garment;
  garment.regions = {"bust"};
  garment.lines.emplace_back();
  garment.lines[0].name = "chest";
  garment.lines[0].ratio = ratio;
  return garment;
}

void report(benchmark::State& state, const Solution& s) {
  state.SetLabel(to_string(s.status));
  state.counters["iterations"] = s.iterations;
  state.counters["residual"] = s.residual;
  state.counters["line_error"] = s.lines[0].final / s.lines[0].neutral - 1;
  state.counters["volume_error"] = s.regions[0].volume_after / s.regions[0].volume_before - 1;
}

void cold(benchmark::State& state, SolverName solver) {
  const Model model = bust(static_cast<int>(state.range(0)));
  SolverOptions options;
  options.solver = solver;
  Solution s;
  for (auto _ : state) s = solve(model, chest(0.90), options);
  report(state, s);
}

void warm(benchmark::State& state, SolverName solver) {
  const Model model = bust(static_cast<int>(state.range(0)));
  SolverOptions options;
  options.solver = solver;
  const Solution start = solve(model, chest(0.91), options);
  Solution s;
  for (auto _ : state) s = solve(model, chest(0.90), options, &start);
  report(state, s);
}

BENCHMARK_CAPTURE(cold, equilibrium, SolverName::equilibrium)
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(warm, equilibrium, SolverName::equilibrium)
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cold, adaptive, SolverName::adaptive)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cold, relaxation, SolverName::relaxation)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
