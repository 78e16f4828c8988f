/// Random solves under a time cap, checked apart from the solver; one JSON line each. Seeds that the file has
/// are left out, so that a run which was stopped goes on: solver_fuzz --seeds 10000 --out solves.jsonl
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "random_solve.hpp"

namespace {

using namespace tensegric_fit;
using nlohmann::json;

using Done = std::map<std::pair<unsigned, std::string>, json>;  // by seed and solver

Done read_done(const std::string& path) {
  Done done;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const json row = json::parse(line, nullptr, false);  // a last line that was cut off is done again
    if (!row.is_discarded()) done[{row["seed"], row["solver"]}] = row;
  }
  return done;
}

json row_of(unsigned seed, const std::string& solver, const solver_fuzz::Finding& f) {
  return {{"seed", seed},           {"solver", solver},
          {"status", f.status},     {"iterations", f.iterations},
          {"residual", f.residual}, {"volume", f.volume_error},
          {"ms", std::round(f.ms)}, {"faults", f.faults}};
}

int summary(const Done& done) {
  std::map<std::string, std::map<std::string, int>> ends;
  std::map<std::string, int> runs, faulty;
  std::map<std::string, double> slowest;
  for (const auto& [key, row] : done) {
    ++ends[key.second][row["status"]];
    ++runs[key.second];
    faulty[key.second] += row["faults"].empty() ? 0 : 1;
    slowest[key.second] = std::max(slowest[key.second], row["ms"].get<double>());
  }
  int faults = 0;
  std::cout << "| solver | solves | with faults | how they ended | slowest, ms |\n| --- | --- | --- | --- | "
               "--- |\n";
  for (const auto& [solver, by_status] : ends) {
    std::string text;
    for (const auto& [status, count] : by_status)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status);
    std::cout << fmt::format("| {} | {} | {} | {} | {:.0f} |\n", solver, runs[solver], faulty[solver], text,
                             slowest[solver]);
    faults += faulty[solver];
  }
  return faults;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Random solves, checked apart from the solver");
  unsigned first = 1, seeds = 100;
  int most_iterations = 0;
  double cap = 10;
  std::string out;
  app.add_option("--first-seed", first, "of the cases");
  app.add_option("--seeds", seeds, "cases, each under three solvers")->check(CLI::PositiveNumber);
  app.add_option("--cap", cap, "s of the processor, for each solve");
  app.add_option("--most-iterations", most_iterations, "of relaxation and adaptive; 0: their own");
  app.add_option("--out", out, "file of JSON lines, which a later run goes on with");
  CLI11_PARSE(app, argc, argv);
  Done done = out.empty() ? Done() : read_done(out);
  std::ofstream file;
  if (!out.empty()) {
    file.open(out, std::ios::trunc);
    for (const auto& [key, row] : done) file << row.dump() << "\n";
  }
  const auto keep = [&](unsigned seed, const char* solver, const solver_fuzz::Finding& found) {
    const json row = row_of(seed, solver, found);
    done[{seed, solver}] = row;
    if (file.is_open()) file << row.dump() << "\n" << std::flush;
    if (!found.faults.empty()) std::cout << row.dump() << "\n" << std::flush;
  };
  for (unsigned seed = first; seed < first + seeds; ++seed) {
    std::vector<const char*> left;
    for (const char* solver : {"equilibrium", "adaptive", "relaxation"})
      if (done.count({seed, solver}) == 0) left.push_back(solver);
    if (left.empty()) continue;
    const stability::Case drawn = solver_fuzz::random_case(seed);
    solver_fuzz::Finding refused;
    const auto model = solver_fuzz::model_of(drawn, refused);
    for (const char* solver : left)
      keep(seed, solver,
           model ? solver_fuzz::solve_and_check(drawn, *model, tensegric::solver_from(solver), cap,
                                                most_iterations)
                 : refused);
  }
  return summary(done) == 0 ? 0 : 1;
}
