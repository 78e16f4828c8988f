/// From the folders of a batch's shards to one table, database and page.
#pragma once

#include <string>
#include <vector>

namespace tensegric_fit::batch {

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out, against;  ///< the other version's table.csv, or empty
  int pictures = 0;          ///< of so many of the least sure, `fit` is run again for its pictures
  bool quiet = false;
};

/// Writes table.csv, costs.csv, table.sqlite and index.html. Exit code: 0 whole, 4 rows are missing or in
/// conflict (all is written), 1 cannot be written, 3 refused.
int merge(const MergeOptions& options);

}  // namespace tensegric_fit::batch
