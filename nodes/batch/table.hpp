/// The results of a batch, whole: one row per row of its manifest.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tensegric_fit::batch {

/// A figure's name (girths.bust) and its value.
using Figure = std::pair<std::string, std::variant<double, std::string>>;

/// All figures of a result: objects by names with dots, lines and regions by theirs, vectors by x, y, z,
/// other lists by how many they hold.
std::vector<Figure> figures_of(const nlohmann::ordered_json& result);

struct Table {
  std::size_t rows = 0;                                     ///< that there are to be
  std::map<std::size_t, nlohmann::ordered_json> lines;      ///< by row
  std::vector<std::size_t> missing;                         ///< rows without a line
  std::map<std::string, std::vector<std::size_t>> doubles;  ///< rows of one key, where they are several
  /// Rows that two folders have with another result: not the same scan, or a result that differs from run to
  /// run. The first folder's line is taken. And rows that shards of one folder, of other numbers of shards,
  /// have of different scans: nothing says which is the newer.
  std::vector<std::size_t> conflicts;
  std::vector<std::string> not_begun;  ///< folders without batch.json
};

/// Of the shards in the folders, whatever their order. Lines of an earlier manifest or build of a folder are
/// left out. \throw Refusal broken_file: no folder has a batch.json, a file that is not of a batch, folders
/// of different manifests or builds. \pre one folder or more
Table read_table(std::vector<std::string> folders);

/// One row each with all figures, without times and memory: the same bytes for the same scans, settings and
/// build.
std::string table_csv(const Table& table);
/// What each row took: row, seconds, cpu_seconds, peak_MB and milliseconds per stage.
std::string costs_csv(const Table& table);

}  // namespace tensegric_fit::batch
