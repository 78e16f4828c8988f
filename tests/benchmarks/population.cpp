/// population: random customers of the virtual booth, or a folder of bodies, measured, fitted with control
/// meshes and compared with what is known of them. Prints, for each family apart, how each figure does
/// against ISO 20685. Bodies of the model family lie in the span of the product's own body model: they show
/// that it is robust, not how accurate it is. Many bodies: a shard per process, then one table of all their
/// files. Exit 0 where of every family 95 % of the figures that count hold, no body is refused and none
/// is missing, else 1; 2 usage, 3 input refused.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <limits>

#include "body_score.hpp"
#include "geometry/status.hpp"
#include "totals.hpp"

namespace {

using namespace tensegric_fit;
using population::Input;
using population::Score;

constexpr double kShareAsked = 0.95;
constexpr int kUsage = 2, kRefused = 3;

struct Request {
  std::vector<std::string> families{"model"};
  int first = 1, bodies = 20;
  bool mesh_only = false, merged = false, totals = false;
  std::string out;
  unsigned shard = 1, shards = 1;   ///< every shards-th body, from the shard-th on
  std::vector<std::string> scores;  ///< files of shards: nothing is measured
  Input input() const {
    return mesh_only ? Input::surface : merged ? Input::merged_scan : Input::assembled_scan;
  }
  std::string input_name() const { return population::input_name(input()); }
};

std::string line_of(const Score& score) {
  if (!score.refusal.empty())
    return fmt::format("{} {}; refused: {}\n", score.family, score.body, score.refusal);
  std::string text;
  for (const population::Figure& f : score.figures)
    if (!f.within() && (f.counts || f.name.rfind("control", 0) == 0))
      text += fmt::format("; {} {:+.1f}{}", f.name, f.error, f.cause.empty() ? "" : " (" + f.cause + ")");
  return fmt::format("{} {}{}\n", score.family, score.body, text.empty() ? "; all within" : text);
}

std::string take_shard(const std::string& text, Request& request) {
  char more = 0;
  if (std::sscanf(text.c_str(), "%u/%u%c", &request.shard, &request.shards, &more) != 2 ||
      request.shard < 1 || request.shard > request.shards)
    return "'" + text + "' is not I/N with 1 <= I <= N";
  return "";
}

/// The scores of the bodies asked for: those that the files have, and the rest measured one after the other;
/// where nothing is to be measured the rest is named, or counted where no body is to be named.
std::vector<Score> measured(const population::Family& family, const Request& request,
                            const std::vector<control_mesh::Template>& patterns) {
  std::vector<Score> known;
  if (!request.out.empty()) {
    population::take_off_unfinished(request.out);
    known = population::read_scores(request.out);
  }
  for (const std::string& file : request.scores)
    for (Score& score : population::read_scores(file)) known.push_back(std::move(score));
  std::vector<Score> scores;
  unsigned place = 0;
  int missing = 0;
  for (const std::string& name : family.bodies(request.first, request.bodies)) {
    if (place++ % request.shards != request.shard - 1) continue;
    const auto found = std::find_if(known.begin(), known.end(), [&](const Score& score) {
      return score.family == family.name() && score.input == request.input_name() && score.body == name;
    });
    if (found != known.end()) {
      scores.push_back(*found);
      continue;
    }
    if (!request.scores.empty()) {
      ++missing;
      if (!request.totals) std::cout << fmt::format("{} {}; no file has it\n", family.name(), name);
      continue;
    }
    bool made = false;  // what could not be read or made is tried again by the next run
    scores.push_back(population::score_of(family, name, request.input(), patterns, &made));
    if (made && !request.out.empty()) population::append_score(request.out, scores.back());
    if (!request.totals) std::cout << line_of(scores.back()) << std::flush;
  }
  if (missing > 0 && request.totals)
    std::cout << fmt::format("{}: {} bodies that no file has\n", family.name(), missing);
  return scores;
}

int run(const Request& request) {
  std::vector<control_mesh::Template> patterns;
  for (const char* name : {"bust", "hips"})
    patterns.push_back(
        control_mesh::load_template(fmt::format("{}/templates/{}.yaml", TENSEGRIC_FIT_LAUNCH, name)));
  std::vector<std::unique_ptr<population::Family>> families;
  for (const std::string& name : request.families) families.push_back(population::family_named(name));
  bool holds = true;
  for (const auto& family : families) {
    const std::vector<Score> scores = measured(*family, request, patterns);
    std::cout << population::table(fmt::format("{}, {}", family->name(), request.input_name()), scores,
                                   !request.totals)
              << std::flush;
    const population::Total total = population::total_of(scores);
    holds = holds && total.refused == 0 && total.share_within() >= kShareAsked;
    if (!request.scores.empty())
      holds = holds && scores.size() == family->bodies(request.first, request.bodies).size();
  }
  return holds ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("Measures bodies and compares with their truth.");
  app.option_defaults()->always_capture_default();
  app.add_option("--family", request.families,
                 "model, implicit, or a folder with NAME_truth.json; may be repeated");
  app.add_option("--first", request.first, "first seed; of a folder the place of its first name")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--bodies", request.bodies, "how many")->check(CLI::PositiveNumber);
  auto* surface =
      app.add_flag("--mesh-only", request.mesh_only, "the true surface: what landmarks alone do wrong");
  app.add_flag("--merged", request.merged, "clouds as they come, columns not moved onto each other")
      ->excludes(surface);
  auto* out = app.add_option("--out", request.out,
                             "a line of JSON a body is added to this file; bodies that it has are not "
                             "measured again, and those that cannot be read or made are not added");
  auto* shard = app.add_option_function<std::string>(
      "--shard",
      [&](const std::string& text) {
        const std::string fault = take_shard(text, request);
        if (!fault.empty()) throw CLI::ValidationError("--shard", fault);
      },
      "I/N: every N-th body, from the I-th on");
  shard->needs(out);
  app.add_option("--scores", request.scores,
                 "files of shards: the table of the bodies asked for, nothing is measured")
      ->check(CLI::ExistingFile)
      ->excludes(out);
  app.add_flag("--totals", request.totals, "name no body: for sets kept for validation");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  try {
    return run(request);
  } catch (const geometry::Refusal& refusal) {
    std::cerr << "population: " << refusal.code() << ": " << (request.totals ? "(a body)" : refusal.what())
              << '\n';
    return kRefused;
  }
}
