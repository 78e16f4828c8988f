#include <CLI/CLI.hpp>
#include <iostream>
#include <thread>

#include "batch/merge.hpp"
#include "batch/run_batch.hpp"
#include "batch/worker.hpp"
#include "files/owner_only.hpp"
#include "fit/parsed_line.hpp"

namespace {

using namespace tensegric_fit::batch;

void take_shard(const std::string& text, BatchOptions& options) {
  char more = 0;
  if (std::sscanf(text.c_str(), "%zu/%zu%c", &options.shard, &options.shards, &more) != 2 ||
      options.shard < 1 || options.shard > options.shards)
    throw CLI::ValidationError("--shard", "'" + text + "' is not I/N with 1 <= I <= N");
}

int merge_main(int argc, char** argv) {
  CLI::App app(
      "From the folders of fit_batch to table.csv, costs.csv, table.sqlite and index.html. Exit: 0 whole, 4 "
      "rows "
      "are missing or in conflict, 2 usage, 3 input refused, 1 cannot be written.",
      "fit_batch merge");
  MergeOptions options;
  app.add_option("DIR", options.folders, "Folders of shards, in any order")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--out", options.out, "Folder for the results")->required();
  app.add_option("--against", options.against, "Another version's table.csv: what differs goes to the page")
      ->check(CLI::ExistingFile);
  app.add_option("--pictures", options.pictures,
                 "Runs fit again on so many of the least sure, for their pictures")
      ->check(CLI::Range(0, 1000));
  app.add_flag("--quiet", options.quiet, "No summary");
  if (const auto code = tensegric_fit::fit::parsed(app, argc, argv, std::cerr, [] {})) return *code;
  return merge(options);
}

int batch_main(int argc, char** argv) {
  CLI::App app(
      "`fit` over a list of scans and garments; started again, it does what is missing. `fit_batch merge "
      "--help`: "
      "the results as one table. Exit: 0 every row has its line, 2 usage, 3 manifest refused, 1 cannot be "
      "written, "
      "130 interrupted.",
      "fit_batch");
  BatchOptions options;
  options.workers = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::string shard = "1/1";
  double gigabytes = static_cast<double>(options.limits.bytes >> 30);
  app.add_option("MANIFEST", options.manifest, "List of scans and garments: .csv or .jsonl")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--out", options.out, "Folder for the results, one line of JSON per row")->required();
  app.add_option("--shard", shard, "I/N: every N-th row, from the I-th on")->capture_default_str();
  app.add_option("--jobs", options.workers, "Scans at once; default: one per core")
      ->check(CLI::Range(1, 1024));
  app.add_option("--time", options.limits.seconds, "Seconds that a scan may take")
      ->capture_default_str()
      ->check(tensegric_fit::fit::number_in(0.1, 86400));
  app.add_option("--memory", gigabytes, "GB of address space that a worker may take")
      ->capture_default_str()
      ->check(tensegric_fit::fit::number_in(0.1, 1024));
  app.add_flag("--retry", options.retry, "Also again what crashed, or took too much time or memory");
  app.add_flag("--quiet", options.quiet, "No progress");
  const auto code =
      tensegric_fit::fit::parsed(app, argc, argv, std::cerr, [&] { take_shard(shard, options); });
  if (code) return *code;
  options.limits.bytes = static_cast<std::size_t>(gigabytes * (1 << 30));
  return run_batch(options);
}

}  // namespace

int main(int argc, char** argv) {
  tensegric_fit::files::owner_only();
  const std::string word = argc > 1 ? argv[1] : "";
  try {
    if (word == "worker" && argc == 3) return work(std::stoull(argv[2]));  // WorkerPool starts it
    return word == "merge" ? merge_main(argc - 1, argv + 1) : batch_main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "fit_batch: " << error.what() << '\n';
    return 1;
  }
}
