// Time and memory beside error. tests/speed_against_error.sh makes a page of it; alone, with medians of five:
//   fit_benchmark --benchmark_repetitions=5 --benchmark_report_aggregates_only=true [--body FILE.ply]
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>

#include "customer.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);  // takes its own options away
  CLI::App program("Time and memory beside error, on a body of the virtual booth or one from a file.");
  std::string body;
  program.add_option("--body", body, "body mesh, PLY, metres")->check(CLI::ExistingFile);
  CLI11_PARSE(program, argc, argv);
  tensegric_fit::benchmarks::choose_body(body);
  benchmark::RunSpecifiedBenchmarks();
}
