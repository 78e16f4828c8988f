#include "batch/drift.hpp"

#include <cmath>
#include <fstream>

#include "files/csv.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::map<std::string, std::string>;

/// Rows of a table.csv by their subject; cells that are empty are left out.
std::map<std::string, Row> rows_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::string> columns, fields;
  std::size_t line = 1;
  if (!stream || !files::read_csv_row(stream, columns, line) || columns.empty() || columns[0] != "row")
    throw geometry::Refusal(geometry::refusal::kBrokenFile, file + " is no table of fit_batch");
  std::map<std::string, Row> rows;
  while (files::read_csv_row(stream, fields, line)) {
    Row row;
    for (std::size_t i = 0; i < std::min(columns.size(), fields.size()); ++i)
      if (!fields[i].empty()) row[columns[i]] = fields[i];
    if (const std::string subject = row["subject"]; !subject.empty()) rows[subject] = std::move(row);
  }
  return rows;
}

struct Sums {
  std::size_t count = 0, row = 0;
  double sum = 0, squares = 0, largest = 0;
};

}  // namespace

Comparison compare(const Table& table, const std::string& file) {
  const std::map<std::string, Row> before = rows_of(file);
  Comparison result;
  std::map<std::string, Sums> sums;
  for (const auto& [row, line] : table.lines) {
    const auto found = before.find(line.value("subject", ""));
    if (found == before.end()) continue;
    ++result.common;
    if (const std::string status = line["status"], old = found->second.at("status"); status != old)
      result.changes.push_back({row, old, status});
    for (const Figure& figure : figures_of(line.value("result", Json::object()))) {
      const auto* now = std::get_if<double>(&figure.second);
      const auto then = found->second.find(figure.first);
      if (now == nullptr || then == found->second.end()) continue;
      const double change = *now - std::strtod(then->second.c_str(), nullptr);
      Sums& all = sums[figure.first];
      ++all.count;
      all.sum += change;
      all.squares += change * change;
      if (std::abs(change) > std::abs(all.largest)) {
        all.largest = change;
        all.row = row;
      }
    }
  }
  for (const auto& [figure, all] : sums) {
    if (all.largest == 0) continue;
    const double n = static_cast<double>(all.count), mean = all.sum / n;
    result.drifts.push_back({figure, all.count, mean, std::sqrt(std::max(0.0, all.squares / n - mean * mean)),
                             all.largest, all.row});
  }
  return result;
}

}  // namespace tensegric_fit::batch
