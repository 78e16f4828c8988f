// Time beside error, and at the end what it comes to. Medians of five:
//   fit_benchmark --benchmark_repetitions=5 --benchmark_report_aggregates_only=true [--body FILE.ply]
#include <benchmark/benchmark.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "customer.hpp"

namespace {

// The usual table; then what we judge ourselves by. CPU time: all of it runs on one thread, whatever else the
// machine does.
class Headlines : public benchmark::ConsoleReporter {
 public:
  Headlines() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      const std::string name =
          run.run_name.function_name + (run.run_name.args.empty() ? "" : "/" + run.run_name.args);
      if (!run.error_occurred && (median || (run.run_type == Run::RT_Iteration && run.repetitions <= 1)))
        milliseconds_[name] = run.GetAdjustedCPUTime();
    }
  }

  void Finalize() override {
    std::printf("\n");
    say("cold solve, 120 control triangles", "cold/equilibrium/120", "at most 8 ms");
    say("warm solve, 120 control triangles", "warm/equilibrium/120", "at most 2 ms");
    say("evaluation, body of 31,000 vertices", "on_body/reference/31000", "at most 1 ms");
    say("evaluation, 31,000 carried vertices", "on_chest_skin/fast/31000", "at most 1 ms");
    compare("ARAP of the body / cold to body", "arap/body", "cold_to_body", "at least 15");
    compare("ARAP of the body / warm to body", "arap/body", "warm_to_body", "");
    compare("ARAP of the region / cold to body", "arap/region", "cold_to_body", "");
    compare("ARAP of the region / warm to body", "arap/region", "warm_to_body", "");
    compare("adaptive / equilibrium, cold", "cold/adaptive/120", "cold/equilibrium/120", "");
    compare("relaxation / equilibrium, cold", "cold/relaxation/120", "cold/equilibrium/120", "");
    compare("fast truncated / reference evaluation", "on_chest_skin/fast_truncated/31000",
            "on_chest_skin/reference/31000", "");
  }

 private:
  void say(const char* what, const std::string& name, const char* wanted) const {
    const auto found = milliseconds_.find(name);
    if (found != milliseconds_.end()) std::printf("%-40s %9.3f ms  %s\n", what, found->second, wanted);
  }

  void compare(const char* what, const std::string& over, const std::string& under,
               const char* wanted) const {
    const auto a = milliseconds_.find(over), b = milliseconds_.find(under);
    if (a != milliseconds_.end() && b != milliseconds_.end())
      std::printf("%-40s %9.2f     %s\n", what, a->second / b->second, wanted);
  }

  std::map<std::string, double> milliseconds_;
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);  // takes its own options away
  CLI::App program("Time beside error, on a body of the virtual booth or one from a file.");
  std::string body;
  program.add_option("--body", body, "body mesh, PLY, metres")->check(CLI::ExistingFile);
  CLI11_PARSE(program, argc, argv);
  tensegric_fit::benchmarks::choose_body(body);
  Headlines headlines;
  benchmark::RunSpecifiedBenchmarks(&headlines);
}
