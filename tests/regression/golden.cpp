#include "golden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "geometry/status.hpp"
#include "golden_shape.hpp"
#include "stamp.hpp"
#include "yaml_values.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;
using geometry::Refusal;

std::string old_of(const Row& row) {
  return row.expectation.value ? to_text(*row.expectation.value) : "none";
}

std::string escaped(const std::string& text) {
  return std::regex_replace(text, std::regex(R"([.^$|()\[\]{}*+?\\])"), R"(\$&)");
}

std::string with_golden(const std::string& text, const Row& row, const std::string& file) {
  const std::string& metric = row.expectation.metric;
  const std::regex line("(\n +" + escaped(metric) + R"(: *\{(?:[^}\n]*,)? *golden: *)([^,}\n]*))");
  std::smatch match;
  if (!row.found) throw Refusal(kBadCase, file + ": " + metric + ": was not found in the run");
  if (!std::regex_search(text, match, line))
    throw Refusal(kBadCase, file + ": " + metric + ": no line '" + metric + ": {golden: ...'");
  return match.prefix().str() + match[1].str() + to_text(*row.found) + match.suffix().str();
}

// Old and new, one line per metric.
std::string changed_values(const Verdict& verdict, const std::string& indent) {
  std::string lines;
  for (const Row& row : verdict.rows)
    if (row.expectation.golden && row.found && old_of(row) != to_text(*row.found))
      lines += fmt::format("{}    {}: [{}, {}]\n", indent, row.expectation.metric, old_of(row),
                           to_text(*row.found));
  return lines;
}

std::string update_entry(const std::string& file, const std::string& reason, const Verdict& verdict,
                         const std::string& indent) {
  const Stamp stamp = stamp_of(file);
  const std::string values = changed_values(verdict, indent);
  return fmt::format("{0}- date: {1}\n{0}  commit: {2}\n{0}  reason: {3}\n{4}", indent, stamp.date,
                     stamp.commit, quoted(reason), values.empty() ? "" : indent + "  values:\n" + values);
}

/// The entries of `updates`, which need not be the last key: a place behind the last one, and how far they
/// stand in. At the end of the text where there are none.
struct Updates {
  std::size_t end;
  std::string indent = "  ";
  bool there = false;
};

Updates updates_in(const std::string& text) {
  static const std::regex key("(^|\n)updates:[ \t]*(#[^\n]*)?\n"), first("^( *)- ");
  std::smatch found, entry;
  if (!std::regex_search(text, found, key)) return {text.size()};
  std::size_t end = static_cast<std::size_t>(found.position() + found.length());
  const std::string behind = text.substr(end);
  Updates updates{end, "  ", true};
  if (std::regex_search(behind, entry, first, std::regex_constants::match_continuous))
    updates.indent = entry[1];
  while (end < text.size() && (text[end] == ' ' || text[end] == '-' || text[end] == '\n')) {
    const bool blank = text[end] == '\n';
    end = std::min(text.find('\n', end), text.size() - 1) + 1;
    if (!blank) updates.end = end;
  }
  return updates;
}

bool is_recorded(const Row& row) {
  return row.expectation.golden || row.expectation.metric.rfind("shape/", 0) == 0;
}

bool is_not_finite(const Row& row) {
  const double* number = row.found ? std::get_if<double>(&*row.found) : nullptr;
  return number != nullptr && !std::isfinite(*number);
}

// Where nothing was recorded before, no metric says so.
bool has_finite_skin(const Recording& recording) {
  const auto& skin =
      recording.deformed.empty() ? recording.body->vertices : recording.deformed.back()->vertices;
  return std::all_of(skin.begin(), skin.end(), [](float number) { return std::isfinite(number); });
}

}  // namespace

std::vector<std::string> against_update(const Case& asked, const Recording& recording,
                                        const Verdict& verdict) {
  std::vector<std::string> reasons = verdict.faults;
  for (const Row& row : verdict.rows)
    if (row.expectation.golden && !row.found)
      reasons.push_back(row.expectation.metric + " was not found");
    else if (is_recorded(row) && is_not_finite(row))
      reasons.push_back(row.expectation.metric + " is not finite" +
                        (row.expectation.golden
                             ? ""
                             : ": where the body's parts are others on purpose, remove shapes/" + asked.name +
                                   ".yaml first"));
  if (wants_shape(asked) && !recording.body)
    reasons.push_back("there is no body whose skin could be recorded");
  else if (wants_shape(asked) && !has_finite_skin(recording))
    reasons.push_back("the skin has a coordinate that is not finite");
  return reasons;
}

std::string update_table(const Case& asked, const Verdict& verdict) {
  std::string table = fmt::format("{}\n  {:<36} {:>16} {:>16} {:>12} {:>10}\n", asked.name, "metric", "old",
                                  "new", "difference", "tolerance");
  for (const Row& row : verdict.rows) {
    if (!is_recorded(row) && row.holds) continue;
    const auto difference = row.difference();
    table += fmt::format("  {:<36} {:>16} {:>16} {:>12} {:>10.3g}{}\n", row.expectation.metric, old_of(row),
                         row.found ? to_text(*row.found) : "not found",
                         difference ? fmt::format("{:+.3g}", *difference) : "", row.expectation.tolerance,
                         row.holds          ? ""
                         : is_recorded(row) ? "  *"
                                            : "  * FAILS, and stays: it is asked for, not recorded");
  }
  return table;
}

void update_goldens(const Case& asked, const Verdict& verdict, const std::string& reason, bool moved) {
  std::ifstream in(asked.file);
  const std::string old{std::istreambuf_iterator<char>(in), {}};
  std::string text = old;
  for (const Row& row : verdict.rows)
    if (row.expectation.golden) text = with_golden(text, row, asked.file);
  if (text == old && !moved) return;
  if (text.back() != '\n') text += '\n';
  const Updates updates = updates_in(text);
  text.insert(updates.end, (updates.there ? "" : "updates:\n") +
                               update_entry(asked.file, reason, verdict, updates.indent));

  const std::string unfinished = asked.file + ".new";
  try {
    std::ofstream out(unfinished);
    out << text;
    out.close();
    if (!out) throw std::runtime_error(unfinished + ": cannot be written");
    if (load_case(unfinished).updates.size() != asked.updates.size() + 1)
      throw Refusal(kBadCase, asked.file + ": 'updates' is no list with an entry per line");
    fs::permissions(unfinished, fs::status(asked.file).permissions());
    fs::rename(unfinished, asked.file);
  } catch (...) {
    std::error_code error;
    fs::remove(unfinished, error);
    throw;
  }
}

}  // namespace tensegric_fit::regression
