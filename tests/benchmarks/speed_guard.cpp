/// speed_guard: has a stage become slower, or larger in memory, than when its cost was last written down?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>

#include "geometry/checked_yaml.hpp"
#include "stage_costs.hpp"

namespace {

using namespace tensegric_fit;
using benchmarks::StageCost;
namespace fs = std::filesystem;

constexpr int kFails = 1, kUsage = 2, kRefused = 3;
constexpr char kBadBaseline[] = "bad_baseline";
constexpr double kWarn = 1.3, kFail = 2;
constexpr double kSmallest = 4;  // MiB; what takes less is counted as that: allocators work in pages

struct CommandLine {
  std::string baseline = TENSEGRIC_FIT_BENCHMARKS "/speed_baseline.yaml", json, reason;
  int rounds = 7;
  bool update = false;
};

struct Baseline {
  std::map<std::string, StageCost> stages;
  std::vector<std::string> updates;
};

Baseline load(const std::string& path) {
  const YAML::Node root = geometry::load_yaml_map(path, kBadBaseline);
  geometry::check_keys(root, {"stages", "updates"}, path, kBadBaseline);
  Baseline baseline;
  for (const auto& entry : root["stages"]) {
    const std::string stage = entry.first.Scalar(), where = path + ": " + stage;
    geometry::check_keys(entry.second, {"kernels", "mebibytes"}, where, kBadBaseline);
    StageCost& cost = baseline.stages[stage];
    cost.kernels = geometry::number_in(entry.second, "kernels", 1e-9, 1e9, where, kBadBaseline);
    cost.mebibytes = geometry::number_in(entry.second, "mebibytes", 0, 1e6, where, kBadBaseline);
  }
  baseline.updates = geometry::optional(root, "updates", baseline.updates, path, kBadBaseline);
  return baseline;
}

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path + ".new");
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
  fs::rename(path + ".new", path);
}

void save(const std::string& path, const std::vector<StageCost>& costs, Baseline baseline,
          const std::string& reason) {
  std::string text =
      "# What stages took when this was last written (speed_guard --update --reason): time in times of the "
      "calibration\n"
      "# kernel, and by how much the process grew.\nstages:\n";
  for (const StageCost& cost : costs)
    text += fmt::format("  {}: {{kernels: {:.3g}, mebibytes: {:.1f}}}\n", cost.stage, cost.kernels,
                        cost.mebibytes);
  baseline.updates.push_back(reason);
  YAML::Emitter updates;
  updates << YAML::BeginMap << YAML::Key << "updates" << YAML::Value << baseline.updates << YAML::EndMap;
  write(path, text + updates.c_str() + "\n");
}

// NaN, of a stage that one side lacks, fails.
std::string word_of(double ratio) {
  return ratio < kWarn ? "ok" : ratio < kFail ? "warning" : "FAILS";
}

/// A stage as it is beside how it was written down; NaN throughout where one side lacks it.
struct Compared {
  StageCost now, then;
};

std::vector<Compared> compared(const std::vector<StageCost>& costs, const Baseline& baseline) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Compared> all;
  for (const StageCost& cost : costs) {
    const auto known = baseline.stages.find(cost.stage);
    all.push_back({cost, known != baseline.stages.end() ? known->second : StageCost{"", kNone, 0, 0, kNone}});
  }
  for (const auto& [stage, then] : baseline.stages)
    if (std::none_of(costs.begin(), costs.end(),
                     [&name = stage](const StageCost& cost) { return cost.stage == name; }))
      all.push_back({{stage, kNone, kNone, kNone, kNone}, then});
  return all;
}

// Prints the table; true where nothing fails.
bool judge(const std::vector<StageCost>& costs, const Baseline& baseline, const CommandLine& line) {
  std::cout << fmt::format("{:<16} {:>9} {:>9} {:>9} {:>7} {:>7} {:>9}   {:>8} {:>9} {:>7}\n", "stage", "ms",
                           "kernels", "baseline", "spread", "ratio", "", "MiB", "baseline", "ratio");
  const auto counted = [](double mebibytes) { return mebibytes < kSmallest ? kSmallest : mebibytes; };
  auto json = nlohmann::ordered_json::array();
  bool holds = true;
  for (const auto& [now, then] : compared(costs, baseline)) {
    const double time = now.kernels / then.kernels, memory = counted(now.mebibytes) / counted(then.mebibytes);
    std::cout << fmt::format(
        "{:<16} {:9.2f} {:9.3g} {:9.3g} {:7.2f} {:7.2f} {:>9}   {:8.1f} {:9.1f} {:7.2f} {:>9}\n", now.stage,
        now.milliseconds, now.kernels, then.kernels, now.spread, time, word_of(time), now.mebibytes,
        then.mebibytes, memory, word_of(memory));
    json.push_back({{"stage", now.stage},  // NaN becomes null
                    {"ms", now.milliseconds},
                    {"kernels", now.kernels},
                    {"baseline_kernels", then.kernels},
                    {"spread", now.spread},
                    {"time_ratio", time},
                    {"time", word_of(time)},
                    {"mib", now.mebibytes},
                    {"baseline_mib", then.mebibytes},
                    {"memory_ratio", memory},
                    {"memory", word_of(memory)},
                    {"rounds", line.rounds}});
    holds = holds && time < kFail && memory < kFail;
  }
  if (!line.json.empty()) write(line.json, json.dump(1) + "\n");
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine line;
  CLI::App app(
      "Time and memory of each stage against a stored baseline: time as a multiple of a calibration kernel "
      "that runs right before it. 1.3 times as much is a warning, twice a failure, and so is a stage that "
      "only one side has. Exit: 0, 1 a failure, 2 usage, 3 the baseline is refused.");
  app.add_option("--baseline", line.baseline, "file of the baseline")->capture_default_str();
  app.add_option("--rounds", line.rounds, "of which medians are taken")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--json", line.json, "also write the table there");
  auto* update = app.add_flag("--update", line.update, "replace the baseline");
  auto* reason = app.add_option("--reason", line.reason, "why; kept in the baseline's file");
  update->needs(reason);
  reason->needs(update);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  try {
    const Baseline baseline = line.update && !fs::exists(line.baseline) ? Baseline() : load(line.baseline);
    const std::vector<StageCost> costs = benchmarks::stage_costs(line.rounds);
    if (!line.update) return judge(costs, baseline, line) ? 0 : kFails;
    save(line.baseline, costs, baseline, line.reason);
    judge(costs, load(line.baseline), line);
    return 0;
  } catch (const geometry::Refusal& refusal) {
    std::cerr << "speed_guard: " << refusal.code() << ": " << refusal.what() << '\n';
    return kRefused;
  } catch (const std::exception& error) {
    std::cerr << "speed_guard: " << error.what() << '\n';
    return kFails;
  }
}
