/// What all bodies of a family say of each figure.
#pragma once

#include <string>
#include <vector>

#include "score_file.hpp"

namespace tensegric_fit::population {

/// Of one figure, millimetres. Where it counts on some bodies, of these; where it counts on none, of all.
struct Row {
  std::string figure;
  double limit = 0;
  bool counts = false;
  int bodies = 0, within = 0, missing = 0;
  int left_out = 0;                ///< bodies on which it does not count
  double bias = 0, deviation = 0;  ///< of the errors found
  int stated = 0, covered = 0;     ///< with a 95 % interval; of these those whose error lies in it
  int sure = 0, sure_out = 0;      ///< with a confidence of 0.5 or more; of these those out of limits
  std::vector<std::string> worst;  ///< the three bodies farthest off, "NAME +1.2"
};

/// In the order in which figures appear.
std::vector<Row> rows_of(const std::vector<Score>& scores);

/// Of the rows that count, as one. `hidden` is filled from figures that no sensor sees.
struct Total {
  Row all, hidden;
  int refused = 0;
  double share_within() const { return all.bodies > 0 ? static_cast<double>(all.within) / all.bodies : 0; }
};
Total total_of(const std::vector<Score>& scores);

/// A table, a line a row, and the totals; with `names` the worst bodies, too.
std::string table(const std::string& family, const std::vector<Score>& scores, bool names);

}  // namespace tensegric_fit::population
