/// How figures differ from those of another version's table.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "batch/table.hpp"

namespace tensegric_fit::batch {

struct Drift {
  std::string figure;
  std::size_t count = 0;                        ///< scans that both have with this figure
  double mean = 0, deviation = 0, largest = 0;  ///< of new - old; the largest by its amount, with its sign
  std::size_t row = 0;                          ///< of the largest
};

/// Scans whose status or whose reason for it changed: row, old, new.
struct StatusChange {
  std::size_t row;
  std::string before, after;
};

/// What has no difference: of a figure, scans in which it is another text, and in which one table has none.
struct OtherChange {
  std::size_t texts = 0, gained = 0, lost = 0;
};

struct Comparison {
  std::size_t common = 0;           ///< scans with the same content and settings
  std::size_t added = 0, gone = 0;  ///< scans of this table and of the other that the other and this lack
  std::vector<Drift> drifts;        ///< of the figures that differ, in the order of the names
  std::vector<StatusChange> changes;
  std::map<std::string, OtherChange> others;  // by figure
};

/// `file`: a table.csv; scans are matched by content and settings. \throw Refusal broken_file
Comparison compare(const Table& table, const std::string& file);

}  // namespace tensegric_fit::batch
