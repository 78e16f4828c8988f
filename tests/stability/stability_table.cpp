/// All hard cases under all three solvers, and a table of how each ended. The long run:
///   stability_table --seeds 10000 --bodies 50 --out stability.md
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>

#include "geometry/status.hpp"
#include "stability_case.hpp"

namespace {

using namespace tensegric_fit;
using stability::Case;
using stability::Ending;
using tensegric::SolverName;

constexpr int kUsage = 2;
constexpr SolverName kSolvers[] = {SolverName::equilibrium, SolverName::adaptive, SolverName::relaxation};

/// How often each status came up under each solver, and the worst of what matters.
struct Summary {
  struct Of {
    std::map<std::string, int> statuses;
    int runs = 0, faults = 0, most_iterations = 0;
    double slowest = 0, worst_residual = 0;  // ms; residual where a balance is claimed
  };
  std::map<std::string, Of> solvers;

  void add(SolverName solver, const Ending& ending) {
    Of& of = solvers[to_string(solver)];
    ++of.statuses[ending.refused ? "refused: " + ending.status : ending.status];
    ++of.runs;
    of.faults += ending.faults.empty() ? 0 : 1;
    of.most_iterations = std::max(of.most_iterations, ending.iterations);
    of.slowest = std::max(of.slowest, ending.ms);
    if (ending.status == "converged" || ending.status == "infeasible")
      of.worst_residual = std::max(of.worst_residual, ending.residual);
  }

  std::string text() const {
    std::string all =
        "| solver | runs | faults | how they ended | most iterations | slowest, ms | worst residual of a "
        "balance |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n";
    for (const auto& [name, of] : solvers) {
      std::string ends;
      for (const auto& [status, count] : of.statuses)
        ends += fmt::format("{}{} {}", ends.empty() ? "" : ", ", count, status);
      all += fmt::format("| {} | {} | {} | {} | {} | {:.0f} | {:.1e} |\n", name, of.runs, of.faults, ends,
                         of.most_iterations, of.slowest, of.worst_residual);
    }
    return all;
  }
};

std::string row_of(const Case& hard, SolverName solver, const Ending& e) {
  std::string faults;
  for (const std::string& fault : e.faults) faults += (faults.empty() ? "**" : "; ") + fault;
  if (!faults.empty()) faults += "**";
  if (e.refused)
    return fmt::format("| {} | {} | refused: {} | | | | | | {} |\n", hard.name, to_string(solver), e.status,
                       faults);
  return fmt::format("| {} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} | {:.0f} | {} |\n", hard.name,
                     to_string(solver), e.status, e.iterations, e.line_error, e.volume_error, e.residual,
                     e.ms, faults);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Hard cases under the three solvers, as a table");
  unsigned seeds = 100, first_seed = 1, bodies = 0;
  std::string out, only, solver_word;
  bool garments = true;
  app.add_option("--seeds", seeds, "starts from random positions");
  app.add_option("--first-seed", first_seed, "of the random starts");
  app.add_option("--bodies", bodies, "drawn at random, for the prestress of every template");
  app.add_option("--garments", garments, "the shipped garments on virtual bodies too");
  app.add_option("--only", only, "cases with this text in their name");
  app.add_option("--solver", solver_word, "this one only")
      ->check(CLI::IsMember({"equilibrium", "adaptive", "relaxation"}));
  app.add_option("--out", out, "file for the table (Markdown)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }

  std::string rows =
      "| case | solver | status | iterations | line error | volume error | residual | ms | faults |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  Summary summary, random_starts;
  bool any = false;
  const auto take = [&](const Case& hard, Summary& into, bool list) {
    if (hard.name.find(only) == std::string::npos) return;
    any = true;
    for (SolverName solver : kSolvers) {
      if (!solver_word.empty() && to_string(solver) != solver_word) continue;
      const Ending ending = run(hard, solver);
      into.add(solver, ending);
      const std::string row = row_of(hard, solver, ending);
      if (list || !ending.faults.empty()) {
        rows += row;
        std::cout << row << std::flush;
      }
    }
  };
  const auto take_all = [&](const std::vector<Case>& cases) {
    for (const Case& hard : cases) take(hard, summary, true);
  };
  take_all(stability::mesh_cases());
  take_all(stability::option_cases());
  take_all(stability::line_cases());
  if (garments)
    for (const char* body : {"firm", "average", "full"})
      take_all(stability::garment_cases(body, {1.3, 1.1, 1.0, 0.97, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3}));
  for (unsigned seed = first_seed; seed < first_seed + seeds; ++seed)
    take(stability::random_start_case(seed), random_starts, false);
  if (!any && !only.empty()) {
    std::cerr << "stability_table: no case has '" << only << "' in its name\n";
    return kUsage;
  }

  int faults = 0;
  std::string prestress;
  for (unsigned body = 1; body <= bodies; ++body) {
    double worst = 0;
    std::string refused;
    try {
      for (const auto& control : stability::template_meshes(body))
        worst = std::max(worst, stability::prestress_residual(control));
    } catch (const geometry::Refusal& refusal) {
      refused = refusal.code() + ": " + refusal.what();
    }
    if (worst > 1e-12 || !refused.empty()) ++faults;
    prestress += fmt::format("| {} | {:.1e} | {} |\n", body, worst, refused);
  }
  if (bodies > 0)
    prestress = "# Prestress\n\n| body | residual | refused |\n| --- | --- | --- |\n" + prestress + "\n";
  for (const Summary* part : {&summary, &random_starts})
    for (const auto& [name, of] : part->solvers) faults += of.faults;
  const std::string text = prestress + "# Hard cases\n\n" + summary.text() +
                           "\n# Starts from random positions\n\n" + random_starts.text() +
                           "\n# One by one\n\nOf the random starts only those with faults.\n\n" + rows;
  std::cout << "\n"
            << prestress << summary.text() << "\n"
            << random_starts.text() << "\n"
            << faults << " faults\n";
  if (!out.empty()) std::ofstream(out) << text;
  return faults == 0 ? 0 : 1;
}
