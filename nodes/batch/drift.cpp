#include "batch/drift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "files/csv.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::map<std::string, std::string>;

constexpr std::array<const char*, 11> kNoFigures{"row",     "name",  "inputs", "settings", "subject", "key",
                                                 "version", "build", "status", "reason",   "message"};

/// Rows of a table.csv by their subject; cells that are empty are left out.
std::map<std::string, Row> read_rows(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::string> columns, fields;
  std::size_t line = 1;
  if (!stream || !files::read_csv_row(stream, columns, line) || columns.empty() || columns[0] != "row")
    throw geometry::Refusal(geometry::refusal::kBrokenFile, file + " is no table of fit_batch");
  for (const char* needed : {"subject", "status"})
    if (std::find(columns.begin(), columns.end(), needed) == columns.end())
      throw geometry::Refusal(geometry::refusal::kBrokenFile, file + " has no column '" + needed + "'");
  std::map<std::string, Row> rows;
  while (files::read_csv_row(stream, fields, line)) {
    Row row;
    for (std::size_t i = 0; i < std::min(columns.size(), fields.size()); ++i)
      if (!fields[i].empty()) row[columns[i]] = fields[i];
    if (const std::string subject = row["subject"]; !subject.empty()) rows[subject] = std::move(row);
  }
  return rows;
}

std::map<std::string, Row> rows_of(const std::string& file) {
  try {
    return read_rows(file);
  } catch (const files::CsvFault& fault) {
    throw geometry::Refusal(geometry::refusal::kBrokenFile, file + " " + fault.what());
  }
}

/// None where the text is no number as a whole.
std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' ? std::optional(number) : std::nullopt;
}

std::string ended(const std::string& status, const std::string& reason) {
  return reason.empty() ? status : status + " (" + reason + ")";
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
  std::set<std::string> met;
  for (const auto& [row, line] : table.lines) {
    const std::string subject = line.value("subject", "");
    if (subject.empty()) continue;  // a file that could not be read: as in the other table
    const auto found = before.find(subject);
    if (found == before.end()) {
      ++result.added;
      continue;
    }
    ++result.common;
    met.insert(found->first);
    Row then = found->second;
    const Json reason = line.value("reason", Json());
    const std::string status = ended(line["status"], reason.is_object() ? reason.value("code", "") : ""),
                      earlier = ended(then["status"], then["reason"]);
    if (status != earlier) result.changes.push_back({row, earlier, status});
    for (const char* name : kNoFigures) then.erase(name);
    if (then.empty() || !line.contains("result")) continue;  // of one that was refused all figures are gone
    for (const Figure& figure : figures_of(line.value("result", Json::object()))) {
      const auto* now = std::get_if<double>(&figure.second);
      const auto* text = std::get_if<std::string>(&figure.second);
      if (text != nullptr && text->empty()) continue;  // as a cell that is empty
      const auto cell = then.extract(figure.first);
      if (cell.empty()) {
        ++result.others[figure.first].gained;
        continue;
      }
      const std::optional<double> old = number_in(cell.mapped());
      if (now == nullptr || !old) {
        result.others[figure.first].texts +=
            text == nullptr || files::no_formula(*text) != cell.mapped() ? 1 : 0;
        continue;
      }
      const double change = *now - *old;
      Sums& all = sums[figure.first];
      ++all.count;
      all.sum += change;
      all.squares += change * change;
      if (std::abs(change) > std::abs(all.largest)) {
        all.largest = change;
        all.row = row;
      }
    }
    for (const auto& cell : then) ++result.others[cell.first].lost;
  }
  result.gone = before.size() - met.size();
  for (auto other = result.others.begin(); other != result.others.end();)
    other = other->second.texts + other->second.gained + other->second.lost == 0 ? result.others.erase(other)
                                                                                 : std::next(other);
  for (const auto& [figure, all] : sums) {
    if (all.largest == 0) continue;
    const double n = static_cast<double>(all.count), mean = all.sum / n;
    result.drifts.push_back({figure, all.count, mean, std::sqrt(std::max(0.0, all.squares / n - mean * mean)),
                             all.largest, all.row});
  }
  return result;
}

}  // namespace tensegric_fit::batch
