/// The list of scans and garments of a batch (launch/pages/many_scans.md).
#pragma once

#include <map>
#include <string>
#include <vector>

namespace tensegric_fit::batch {

/// One row: options of `fit`, by their names without dashes in front and with _ for -, values in order.
struct Job {
  std::size_t row = 0;  ///< 1 for the first
  std::string name;     ///< the manifest's own, may be empty
  std::map<std::string, std::vector<std::string>> options;

  /// Its scans or its mesh.
  std::vector<std::string> inputs() const;
  /// As `fit` takes them.
  std::vector<std::string> arguments() const;
};

inline constexpr std::size_t kMostRows = 10'000'000;  ///< months of a large machine

/// Reads FILE.csv (first row: names of columns; several scans or ratios with ; in between) or FILE.jsonl (one
/// object per line). Columns are `name` and options of `fit`; paths are relative to the manifest.
/// \throw Refusal broken_file, naming file and line: not readable, unknown columns, values that `fit`
/// refuses, more than kMostRows
std::vector<Job> read_manifest(const std::string& file);

}  // namespace tensegric_fit::batch
