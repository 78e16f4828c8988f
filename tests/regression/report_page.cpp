#include <fmt/format.h>

#include <algorithm>

#include "case_pictures.hpp"
#include "files/html.hpp"
#include "history_plot.hpp"
#include "report.hpp"

namespace tensegric_fit::regression {
namespace {

constexpr char kStyle[] = R"(
:root { color-scheme: light dark; --good: #2a7d4f; --bad: #b3261e; --line: #8884; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 0 auto; max-width: 78rem; padding: 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .3rem; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .87rem; margin: .4rem 0; }
th, td { border-bottom: 1px solid var(--line); padding: .15rem .6rem; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
figure { display: inline-block; margin: .3rem .5rem .3rem 0; vertical-align: top; max-width: 100%; }
img { max-width: 100%; height: auto; background: white; } figcaption { font-size: .8rem; opacity: .75; }
.wide td:last-child { min-width: 14rem; }
summary { cursor: pointer; })";

std::string mark(bool holds) {
  return holds ? "<span class=good>holds</span>" : "<span class=bad>FAILS</span>";
}

std::string cell(const std::string& text) {
  return "<td class=n>" + files::html_escaped(text) + "</td>";
}

std::string row_of(const Row& row) {
  const Expectation& asked = row.expectation;
  const auto difference = row.difference();
  return "<tr><td>" + files::html_escaped(asked.metric) + "</td>" +
         cell(asked.value ? to_text(*asked.value) : "nothing so far") +
         cell(row.found ? to_text(*row.found) : "not found") +
         cell(difference ? fmt::format("{:+.3g}", *difference) : "") +
         cell(asked.tolerance > 0 ? fmt::format("{:g}", asked.tolerance) : "") +
         cell(row.error ? fmt::format("{:+.3g}", *row.error) : "") + "<td>" + mark(row.holds) + "</td><td>" +
         (asked.golden ? "recorded: " : "") + files::html_escaped(asked.reason) + "</td></tr>\n";
}

std::string table_of(const std::vector<Row>& rows) {
  std::string table =
      "<div class=wide><table><tr><th>metric<th>expected<th>found<th>difference<th>tolerance<th>error to the "
      "truth<th><th>why</tr>\n";
  for (const Row& row : rows) table += row_of(row);
  return table + "</table></div>\n";
}

std::string costs_of(const Verdict& verdict) {
  std::string row;
  for (const std::string stage :
       {"assembler", "reconstruction", "landmarks", "control_mesh", "tensegric", "tffd"}) {
    const auto time = verdict.metrics.find("time/" + stage), memory = verdict.metrics.find("memory/" + stage);
    if (time == verdict.metrics.end()) continue;
    row += fmt::format(
        "<td>{}</td>{}{}</tr><tr>", stage, cell(fmt::format("{:.1f} ms", std::get<double>(time->second))),
        cell(memory == verdict.metrics.end() ? ""
                                             : fmt::format("{:.0f} MiB", std::get<double>(memory->second))));
  }
  return "<table><tr><th>stage<th>time<th>peak memory</tr><tr>" + row + "</tr></table>\n";
}

std::string verdict_of(const Verdict& verdict) {
  std::string html = fmt::format("<h3>{} runner: {}</h3>\n", verdict.runner, mark(verdict.holds()));
  for (const std::string& fault : verdict.faults)
    html += "<p class=bad>" + files::html_escaped(fault) + "</p>\n";
  for (const std::string& note : verdict.notes) html += "<p>" + files::html_escaped(note) + "</p>\n";
  std::vector<Row> failing, holding;
  for (const Row& row : verdict.rows) (row.holds ? holding : failing).push_back(row);
  if (!failing.empty()) html += table_of(failing);
  html += fmt::format("<details><summary>{} metrics that hold, time, memory</summary>\n", holding.size());
  return html + table_of(holding) + costs_of(verdict) + "</details>\n";
}

std::string section_of(const Outcome& outcome) {
  std::string html =
      fmt::format("<h2 id=\"{0}\">{0}: {1}</h2>\n<p>{2}</p>\n", files::html_escaped(outcome.asked.name),
                  mark(outcome.holds()), files::html_escaped(outcome.asked.about));
  if (has_fit(outcome.recording))
    html += fmt::format("<p><a href=\"{0}.html\">{0} in 3D</a>, and its measures</p>\n",
                        files::html_escaped(outcome.asked.name));
  for (const CasePicture& picture : pictures_of(outcome.recording))
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        picture.caption, files::base64(picture.png));
  for (std::size_t i = 0; i < outcome.recording.histories.size(); ++i) {
    const std::string plot = history_plot(outcome.recording.histories[i]);
    if (!plot.empty())
      html += fmt::format("<figure>{}<figcaption>how {} went</figcaption></figure>\n", plot,
                          files::html_escaped(outcome.recording.fits[i]->garment));
  }
  for (const Verdict& verdict : outcome.verdicts) html += verdict_of(verdict);
  if (!outcome.recording.scan_id.empty()) {
    html += "<details><summary>SHA-256 of the payloads of scan " + outcome.recording.scan_id +
            "</summary>\n<div class=wide><table>";
    for (const auto& [topic, hash] : hashes_of(outcome.recording))
      html += "<tr><td>" + topic + "</td><td><code>" + hash + "</code></td></tr>\n";
    html += "</table></div></details>\n";
  }
  if (!outcome.asked.updates.empty()) {
    html += "<details><summary>Why golden values were replaced</summary><ol>\n";
    for (const Update& update : outcome.asked.updates) {
      html += "<li>" + files::html_escaped(update.reason);
      if (!update.date.empty())
        html += fmt::format(" ({}, {})", update.date, files::html_escaped(update.commit));
      for (const auto& [metric, values] : update.values)
        html += fmt::format("<br>{}: {} → {}", files::html_escaped(metric), files::html_escaped(values.first),
                            files::html_escaped(values.second));
      html += "</li>\n";
    }
    html += "</ol></details>\n";
  }
  return html;
}

std::string overview_of(const std::vector<Outcome>& outcomes) {
  std::string html = "<div class=wide><table><tr><th>case<th>bag<th>replay<th>seconds<th>about</tr>\n";
  for (const Outcome& outcome : outcomes) {
    html += fmt::format("<tr><td><a href=\"#{0}\">{0}</a></td>", files::html_escaped(outcome.asked.name));
    for (const std::string runner : {"bag", "replay"}) {
      const auto verdict = std::find_if(outcome.verdicts.begin(), outcome.verdicts.end(),
                                        [&](const Verdict& v) { return v.runner == runner; });
      html += "<td>" + (verdict == outcome.verdicts.end() ? "" : mark(verdict->holds())) + "</td>";
    }
    html += cell(fmt::format("{:.1f}", outcome.seconds)) + "<td>" + files::html_escaped(outcome.asked.about) +
            "</td></tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string page_begin(const std::string& title, const std::string& verdict) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\"><title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}: "
      "{2}</h1>\n",
      title, kStyle, verdict);
}

std::string html_page(const std::vector<Outcome>& outcomes) {
  const auto failing = std::count_if(outcomes.begin(), outcomes.end(),
                                     [](const Outcome& outcome) { return !outcome.holds(); });
  const std::string verdict =
      failing == 0 ? fmt::format("<span class=good>all {} cases hold</span>", outcomes.size())
                   : fmt::format("<span class=bad>{} of {} cases fail</span>", failing, outcomes.size());
  std::string html = page_begin("Regression", verdict);
  html += overview_of(outcomes);
  for (const Outcome& outcome : outcomes) html += section_of(outcome);
  return html + "</body></html>\n";
}

}  // namespace tensegric_fit::regression
