#include "batch/merge.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "batch/batch_page.hpp"
#include "batch/database.hpp"
#include "batch/drift.hpp"
#include "batch/identity.hpp"
#include "batch/manifest.hpp"
#include "batch/table.hpp"
#include "fit/result_folder.hpp"
#include "geometry/spawned_process.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kIncomplete = 4;

Job job_of(const Json& line) {
  Job job;
  for (const auto& [name, values] : line["settings"].items())
    job.options[name] = values.get<std::vector<std::string>>();
  job.options[line["kind"]] = line["inputs"].get<std::vector<std::string>>();
  return job;
}

/// Whether its files are those that its figures are of.
bool has_its_files(const Job& job, const Json& line) {
  try {
    return identity_of(job, "").subject == line["subject"];
  } catch (const geometry::Refusal&) {
    return false;
  }
}

/// `fit` once more, for its pictures. Whether it went well.
bool draw(const Json& line, const std::string& out) {
  const Job job = job_of(line);
  if (!has_its_files(job, line)) {
    fmt::print(stderr, "row {}: no picture: a file of it is another now, or cannot be read\n",
               line["row"].get<std::size_t>());
    return false;
  }
  std::vector<std::string> arguments = job.arguments();
  arguments.insert(arguments.end(), {"--out=" + out, "--quiet"});
  const geometry::SpawnedProcess fit = geometry::spawn(geometry::sibling_program("fit"), arguments);
  close(fit.channel);
  return geometry::wait_for(fit.id) == 0;
}

void write(const Table& table, const MergeOptions& options) {
  const fs::path out = options.out;
  fs::create_directories(out);
  std::optional<Comparison> comparison;
  if (!options.against.empty()) comparison = compare(table, options.against);
  std::map<std::size_t, std::string> pictures;
  for (const std::size_t row : least_sure(table, static_cast<std::size_t>(options.pictures))) {
    const std::string folder = fmt::format("least_sure/{}", row);
    if (draw(table.lines.at(row), (out / folder).string())) pictures[row] = folder;
  }
  fit::write_text((out / "table.csv").string(), table_csv(table));
  fit::write_text((out / "costs.csv").string(), costs_csv(table));
  write_database(table, (out / "table.sqlite").string());
  fit::write_text((out / "index.html").string(), batch_page(table, comparison, pictures));
}

}  // namespace

int merge(const MergeOptions& options) {
  try {
    const Table table = read_table(options.folders);
    for (const std::string& folder : table.not_begun)
      fmt::print(stderr, "{} has no batch.json: its shard has not begun, or it is none of fit_batch\n",
                 folder);
    write(table, options);
    const bool whole = table.missing.empty() && table.conflicts.empty();
    if (!options.quiet)
      fmt::print(stderr, "{} of {} rows, {} missing, {} doubles, {} conflicts: {}\n", table.lines.size(),
                 table.rows, table.missing.size(), table.doubles.size(), table.conflicts.size(),
                 (fs::path(options.out) / "index.html").string());
    return whole ? 0 : kIncomplete;
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return refusal.code() == geometry::refusal::kCannotWrite ? 1 : 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "fit_batch merge: {}\n", error.what());
    return 1;
  }
}

}  // namespace tensegric_fit::batch
