/// regression: runs cases, compares them with what is expected of them, writes reports.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "case_pictures.hpp"
#include "compare.hpp"
#include "files/owner_only.hpp"
#include "geometry/status.hpp"
#include "golden.hpp"
#include "golden_shape.hpp"
#include "record.hpp"
#include "report.hpp"

namespace {

using namespace tensegric_fit;
namespace fs = std::filesystem;

constexpr int kFails = 1, kUsage = 2, kRefused = 3;

struct CommandLine {
  std::vector<std::string> names;
  std::string cases = TENSEGRIC_FIT_CASES, runner = "both", out = "regression_out", reason;
  int repeat = 1;
  bool update = false;
  regression::RecordRequest record;
  std::string one, other;  // to be compared
};

void say(const regression::Outcome& outcome) {
  std::cout << fmt::format("{:<28} {:5.1f} s", outcome.asked.name, outcome.seconds);
  for (const regression::Verdict& verdict : outcome.verdicts)
    std::cout << fmt::format("  {} {}", verdict.runner, verdict.holds() ? "holds" : "FAILS");
  std::cout << '\n';
  for (const regression::Verdict& verdict : outcome.verdicts) {
    for (const std::string& fault : verdict.faults)
      std::cout << fmt::format("  {}: {}\n", verdict.runner, fault);
    for (const std::string& note : verdict.notes)
      std::cout << fmt::format("  {}, no failure: {}\n", verdict.runner, note);
    for (const regression::Row& row : verdict.rows) {
      if (row.holds) continue;
      const auto difference = row.difference();
      std::cout << fmt::format(
          "  {}: {} is {}, expected {}{} ({})\n", verdict.runner, row.expectation.metric,
          row.found ? regression::to_text(*row.found) : "not found",
          row.expectation.value ? regression::to_text(*row.expectation.value) : "nothing so far",
          difference ? fmt::format(" +- {:g}: off by {:+.3g}", row.expectation.tolerance, *difference) : "",
          row.expectation.reason);
    }
  }
  std::cout << std::flush;
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

// Cases whose run is none to record from stay as they are.
int update_all(const std::vector<regression::Outcome>& outcomes, const std::string& why) {
  bool all = true;
  for (const auto& [asked, recording, verdicts, seconds] : outcomes) {
    std::cout << regression::update_table(asked, verdicts.front());
    const auto reasons = regression::against_update(asked, recording, verdicts.front());
    for (const std::string& reason : reasons) std::cout << fmt::format("  not updated: {}\n", reason);
    all = all && reasons.empty();
    if (!reasons.empty()) continue;
    const bool moved = regression::wants_shape(asked) && regression::has_moved(asked, recording);
    // Goldens first: what they refuse leaves the shape as it was.
    regression::update_goldens(asked, verdicts.front(), why, moved);
    if (moved) regression::write_shape(asked, recording);
  }
  return all ? 0 : kFails;
}

int run(const CommandLine& line) {
  regression::HarnessOptions options;
  options.bag = line.runner != "replay";
  options.replay = line.runner != "bag";
  options.repeat = line.repeat;
  options.folder = line.out;
  std::vector<regression::Outcome> outcomes;
  bool holds = true;
  for (const regression::Case& asked : regression::load_cases(line.cases, line.names)) {
    outcomes.push_back(regression::run_case(asked, options));
    holds = holds && outcomes.back().holds();
    if (!line.update) say(outcomes.back());
  }
  if (line.update) return update_all(outcomes, line.reason);
  write(fs::path(line.out) / "junit.xml", regression::junit_xml(outcomes));
  write(fs::path(line.out) / "metrics.jsonl", regression::json_lines(outcomes));
  write(fs::path(line.out) / "report.html", regression::html_page(outcomes));
  for (const regression::Outcome& outcome : outcomes)
    if (regression::has_fit(outcome.recording))
      write(fs::path(line.out) / (outcome.asked.name + ".html"), regression::fit_page(outcome.recording));
  std::cout << fmt::format("{}\n", (fs::path(line.out) / "report.html").string());
  return holds ? 0 : kFails;
}

int record(CommandLine line) {
  line.record.cases = line.cases;
  regression::write_case_input(line.record);
  regression::HarnessOptions options;
  options.replay = false;
  options.folder = line.out;
  const regression::Outcome outcome = regression::add_everything_found(line.record, options);
  std::cout << fmt::format(
      "{}: {} values recorded{}\nscan: {}\nPrune the values, then: regression --cases {} {}\n",
      outcome.asked.file, outcome.asked.expectations.size(),
      outcome.recording.refusal.empty()
          ? ""
          : fmt::format("; {} refuses the scan: {}", outcome.recording.refused_by, outcome.recording.refusal),
      outcome.asked.bag, line.cases, outcome.asked.name);
  return 0;
}

int compare(const CommandLine& line) {
  const auto comparisons = regression::compare_runs(line.one, line.other);
  bool same = true;
  for (const regression::RunComparison& comparison : comparisons) {
    std::cout << regression::to_text(comparison);
    same = same && comparison.same();
  }
  fs::create_directories(line.out);
  write(fs::path(line.out) / "differences.jsonl", regression::differences_json(comparisons));
  write(fs::path(line.out) / "compare.html", regression::differences_page(comparisons));
  std::cout << (fs::path(line.out) / "compare.html").string() << '\n';
  return same ? 0 : kFails;
}

}  // namespace

int main(int argc, char** argv) {
  files::owner_only();
  CommandLine line;
  CLI::App app(
      "Runs cases of the regression harness through the stages' handlers (bag) and through the launched "
      "chain "
      "(replay). Exit: 0 all hold, 1 some fail, 2 usage, 3 a case file or its input is refused.");
  app.add_option("CASE", line.names, "cases by name; none, or all: all");
  app.add_option("--cases", line.cases, "folder of the case files")->capture_default_str();
  app.add_option("--runner", line.runner, "bag, replay or both")
      ->capture_default_str()
      ->check(CLI::IsMember({"bag", "replay", "both"}));
  app.add_option("--repeat", line.repeat, "runs of the bag runner, which must all give the same bits")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--out", line.out, "folder for reports, bags and logs")->capture_default_str();
  auto* update =
      app.add_flag("--update", line.update, "replace the golden values of the cases that are named");
  auto* reason = app.add_option("--reason", line.reason, "why they are replaced; kept in the case files");
  update->needs(reason);
  reason->needs(update);
  auto* record_it = app.add_subcommand("record", "Makes a case from a bag, with everything that is found");
  record_it->add_option("BAG", line.record.bag, "a scan, or clouds of all sensors; its garments are worn")
      ->required();
  record_it->add_option("--name", line.record.name, "of the case")->required();
  record_it->add_option("--about", line.record.about, "a sentence for people");
  record_it->add_option("--garment", line.record.garments,
                        "worn in place of the bag's, one after the other; none: measure only");
  record_it->add_option("--scan", line.record.scan, "which of several scans")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  auto* compare_them =
      app.add_subcommand("compare",
                         "Says where two runs differ: which topic, which field, where on the body. "
                         "Exit: 0 the same, 1 they differ");
  compare_them->add_option("ONE", line.one, "a bag with what came out, or a folder of --out")->required();
  compare_them->add_option("OTHER", line.other, "the same of another run, parameter or version")->required();
  for (CLI::App* command : {record_it, compare_them}) command->fallthrough();
  app.require_subcommand(0, 1);
  try {
    app.parse(argc, argv);
    if (line.update && (line.names.empty() || line.reason.empty()))
      throw CLI::ValidationError("--update", "needs the names of cases (or all), and a reason");
    if (line.names == std::vector<std::string>{"all"}) line.names.clear();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  if (line.update) line.runner = "bag";
  try {
    if (record_it->parsed()) return record(line);
    if (compare_them->parsed()) return compare(line);
    return run(line);
  } catch (const geometry::Refusal& refusal) {
    std::cerr << "regression: " << refusal.code() << ": " << refusal.what() << '\n';
    return kRefused;
  } catch (const std::exception& error) {
    std::cerr << "regression: " << error.what() << '\n';
    return kFails;
  }
}
