#include "batch/batch_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "files/html.hpp"
#include "geometry/percentile.hpp"

namespace tensegric_fit::batch {
namespace {

using Json = nlohmann::ordered_json;
using files::html_escaped;

constexpr char kStyle[] = R"(
:root { color-scheme: light dark; --line: #8884; --bar: #4a7ab5; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 0 auto; max-width: 70rem; padding: 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .3rem; }
table { border-collapse: collapse; font-size: .87rem; margin: .4rem 0; }
th, td { border-bottom: 1px solid var(--line); padding: .15rem .6rem; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
figure { display: inline-block; margin: .3rem .8rem .3rem 0; } figcaption { font-size: .8rem; opacity: .8; }
.wide { overflow-x: auto; }
svg rect { fill: var(--bar); } svg text { font: 10px system-ui, sans-serif; fill: currentColor; })";

constexpr int kBars = 24, kWidth = 240, kHeight = 90;
constexpr std::size_t kListed = 20;

std::string number(double value) {
  return "<td class=n>" + fmt::format("{:.4g}", value) + "</td>";
}

std::string whole_number(std::size_t value) {
  return fmt::format("<td class=n>{}</td>", value);
}

/// Empty where it is not there.
Json part_of(const Json& whole, const char* path) {
  const Json::json_pointer place(path);
  return whole.contains(place) ? whole.at(place) : Json::object();
}

/// A histogram from the smallest to the largest value; median and 95 % below it.
std::string histogram(const std::string& title, const std::string& unit, std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const double low = values.front(), width = std::max(values.back() - low, 1e-12);
  std::vector<int> counts(kBars);
  for (const double v : values) ++counts[std::min(kBars - 1, static_cast<int>((v - low) / width * kBars))];
  const int most = *std::max_element(counts.begin(), counts.end());
  std::string bars;
  for (int i = 0; i < kBars; ++i) {
    const double height = static_cast<double>(kHeight) * counts[i] / most;
    bars += fmt::format("<rect x={} y={:.1f} width={} height={:.1f} />", i * kWidth / kBars, kHeight - height,
                        kWidth / kBars - 1, height);
  }
  return fmt::format(
      "<figure><svg width={0} height={1} role=img aria-label=\"{2}\">{3}<text x=0 y={4}>{5:.4g}</text><text "
      "x={0} "
      "y={4} text-anchor=end>{6:.4g} {7}</text></svg><figcaption>{2}: n {8}, median {9:.4g}, 95 % below "
      "{10:.4g} "
      "{7}</figcaption></figure>\n",
      kWidth, kHeight + 14, html_escaped(title), bars, kHeight + 12, low, values.back(), unit, values.size(),
      geometry::percentile(values, 0.5), geometry::percentile(values, 0.95));
}

std::string summary(const Table& table) {
  std::map<std::string, std::size_t> statuses, reasons;
  for (const auto& [row, line] : table.lines) {
    ++statuses[line["status"]];
    if (line["reason"].is_object()) ++reasons[line["reason"]["code"]];
  }
  std::string text = fmt::format("<p>{} rows, {} done", table.rows, table.lines.size());
  for (const auto& [status, count] : statuses) text += fmt::format(", {} {}", count, html_escaped(status));
  text += fmt::format("; {} missing, {} keys that are there more than once, {} conflicts.</p>\n",
                      table.missing.size(), table.doubles.size(), table.conflicts.size());
  const auto list = [&text](const char* what, const std::vector<std::size_t>& rows) {
    if (rows.empty()) return;
    text += fmt::format("<p>{}: rows", what);
    for (std::size_t i = 0; i < std::min(rows.size(), kListed); ++i) text += fmt::format(" {}", rows[i]);
    text += rows.size() > kListed ? " ...</p>\n" : "</p>\n";
  };
  list("Missing", table.missing);
  list("Conflicts, where folders or shards have different results", table.conflicts);
  for (const auto& [key, rows] : table.doubles) list("The same scan and settings", rows);
  text += "<h2>Without a result, by reason</h2>\n<table><tr><th>reason<th>scans</tr>\n";
  for (const auto& [reason, count] : reasons)
    text += "<tr><td>" + html_escaped(reason) + "</td>" + whole_number(count) + "</tr>\n";
  return text + "</table>\n";
}

/// What is no number, or one that no scan comes to and that sums and widths of bars would overflow with, is
/// left out.
void take(const Json& value, double scale, std::vector<double>& values) {
  constexpr double kLargest = 1e100;
  if (value.is_number() && std::abs(value.get<double>()) < kLargest)
    values.push_back(scale * value.get<double>());
}

std::string distributions(const Table& table) {
  std::map<std::string, std::vector<double>> girths, costs, sure;
  for (const auto& [row, line] : table.lines) {
    const Json cost = line.value("cost", Json::object()), result = line.value("result", Json::object());
    for (const char* name : {"seconds", "cpu_seconds", "peak_MB"})
      if (cost.contains(name)) take(cost[name], 1, costs[name]);
    const Json lengths = part_of(result, "/girths"), confidences = part_of(result, "/confidence/girths");
    for (const auto& [name, value] : lengths.items()) take(value, 1000, girths[name]);
    for (const auto& [name, value] : confidences.items())
      if (value.contains("half_width")) take(value["half_width"], 1000, sure[name]);
  }
  std::string text = "<h2>Girths</h2>\n";
  for (const auto& [name, values] : girths) text += histogram(name, "mm", values);
  text += "<h2>95 % half-widths of girths</h2>\n";
  for (const auto& [name, values] : sure) text += histogram(name, "mm", values);
  text += "<h2>What a scan takes</h2>\n";
  for (const auto& [name, values] : costs) text += histogram(name, name == "peak_MB" ? "MB" : "s", values);
  return text;
}

/// Mean confidence of the girths, 1 where there is none.
double sureness(const Json& line) {
  const Json girths = part_of(line, "/result/confidence/girths");
  double sum = 0, count = 0;
  for (const Json& girth : girths) {
    if (!girth.is_object() || !girth.contains("confidence") || !girth["confidence"].is_number()) continue;
    sum += girth["confidence"].get<double>();
    ++count;
  }
  return count > 0 ? sum / count : 1;
}

std::string row_link(const Table& table, std::size_t row,
                     const std::map<std::size_t, std::string>& pictures) {
  const Json& line = table.lines.at(row);
  const std::string name = line["name"],
                    input = line["inputs"].empty() ? "" : line["inputs"][0].get<std::string>();
  std::string text = fmt::format("<td>{}</td><td>{}</td>", row, html_escaped(name.empty() ? input : name));
  if (const auto found = pictures.find(row); found != pictures.end()) {
    text += "<td>";
    for (const char* view : {"front", "side"})
      text += fmt::format("<a href=\"{0}/{1}.png\">{1}</a> ", html_escaped(found->second), view);
    return text + "</td>";
  }
  return text + "<td></td>";
}

std::string worst(const Table& table, const std::map<std::size_t, std::string>& pictures) {
  std::string text =
      "<h2>Least sure</h2>\n<table><tr><th>row<th>scan<th>pictures<th>mean confidence of girths</tr>\n";
  for (const std::size_t row : least_sure(table, kListed))
    text += "<tr>" + row_link(table, row, pictures) + number(sureness(table.lines.at(row))) + "</tr>\n";
  std::vector<std::pair<double, std::size_t>> slow;
  for (const auto& [row, line] : table.lines)
    if (line.contains("cost") && line["cost"].contains("seconds"))
      slow.emplace_back(line["cost"]["seconds"], row);
  std::sort(slow.rbegin(), slow.rend());
  text += "</table>\n<h2>Slowest</h2>\n<table><tr><th>row<th>scan<th>pictures<th>seconds</tr>\n";
  for (std::size_t i = 0; i < std::min(slow.size(), kListed); ++i)
    text += "<tr>" + row_link(table, slow[i].second, pictures) + number(slow[i].first) + "</tr>\n";
  return text + "</table>\n";
}

std::string drift(const Comparison& comparison) {
  std::set<std::string> figures;
  for (const Drift& one : comparison.drifts) figures.insert(one.figure);
  for (const auto& other : comparison.others) figures.insert(other.first);
  std::string text = fmt::format(
      "<h2>Against the other table</h2>\n<p>{} scans in common, {} in this table alone, {} in the other "
      "alone; {} with another status or reason, {} figures differ.</p>\n"
      "<div class=wide><table><tr><th>figure<th>scans<th>mean of new - "
      "old<th>deviation<th>largest<th>row</tr>\n",
      comparison.common, comparison.added, comparison.gone, comparison.changes.size(), figures.size());
  for (const Drift& one : comparison.drifts)
    text += "<tr><td>" + html_escaped(one.figure) + "</td>" + whole_number(one.count) + number(one.mean) +
            number(one.deviation) + number(one.largest) + whole_number(one.row) + "</tr>\n";
  text += "</table></div>\n";
  for (const auto& [figure, other] : comparison.others)
    text += fmt::format("<p>{}: another text in {} scans, new in {}, gone in {}</p>\n", html_escaped(figure),
                        other.texts, other.gained, other.lost);
  for (const StatusChange& change : comparison.changes)
    text += fmt::format("<p>row {}: {} before, {} now</p>\n", change.row, html_escaped(change.before),
                        html_escaped(change.after));
  return text;
}

}  // namespace

std::vector<std::size_t> least_sure(const Table& table, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> rows;
  for (const auto& [row, line] : table.lines)
    if (line["status"] == "ok") rows.emplace_back(sureness(line), row);
  std::sort(rows.begin(), rows.end());
  rows.resize(std::min(rows.size(), count));
  std::vector<std::size_t> worst;
  worst.reserve(rows.size());
  for (const auto& [sure, row] : rows) worst.push_back(row);
  return worst;
}

std::string batch_page(const Table& table, const std::optional<Comparison>& comparison,
                       const std::map<std::size_t, std::string>& pictures) {
  return "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport "
         "content=\"width=device-width\">"
         "<title>Batch</title><style>" +
         std::string(kStyle) + "</style>\n<h1>Batch</h1>\n" + summary(table) +
         (comparison ? drift(*comparison) : "") + distributions(table) + worst(table, pictures) + "</html>\n";
}

}  // namespace tensegric_fit::batch
