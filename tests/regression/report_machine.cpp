#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "files/html.hpp"
#include "report.hpp"

namespace tensegric_fit::regression {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const Value& value) {
  if (const double* number = std::get_if<double>(&value)) return *number;
  return std::get<std::string>(value);
}

std::string words_of(const Verdict& verdict) {
  std::string words;
  for (const std::string& fault : verdict.faults) words += fault + "\n";
  for (const Row& row : verdict.rows) {
    if (row.holds) continue;
    const Expectation& asked = row.expectation;
    words += fmt::format(
        "{}: {}, expected {} +- {:g} ({})\n", asked.metric, row.found ? to_text(*row.found) : "not found",
        asked.value ? to_text(*asked.value) : "nothing so far", asked.tolerance, asked.reason);
  }
  return words;
}

std::string test_case(const Outcome& outcome, const Verdict& verdict) {
  const std::string failure =
      verdict.holds()
          ? ""
          : fmt::format("<failure message=\"{} of {} metrics, {} faults\">{}</failure>", verdict.failures(),
                        verdict.rows.size(), verdict.faults.size(), files::html_escaped(words_of(verdict)));
  return fmt::format("    <testcase classname=\"regression.{}\" name=\"{}\" time=\"{:.3f}\">{}</testcase>\n",
                     verdict.runner, files::html_escaped(outcome.asked.name), outcome.seconds, failure);
}

}  // namespace

std::string junit_xml(const std::vector<Outcome>& outcomes) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const std::string runner : {"bag", "replay"}) {
    int tests = 0, failures = 0;
    std::string cases;
    for (const Outcome& outcome : outcomes)
      for (const Verdict& verdict : outcome.verdicts) {
        if (verdict.runner != runner) continue;
        ++tests;
        failures += !verdict.holds();
        cases += test_case(outcome, verdict);
      }
    if (tests != 0)
      xml +=
          fmt::format("  <testsuite name=\"regression.{}\" tests=\"{}\" failures=\"{}\">\n{}  </testsuite>\n",
                      runner, tests, failures, cases);
  }
  return xml + "</testsuites>\n";
}

std::string json_lines(const std::vector<Outcome>& outcomes) {
  std::string lines;
  for (const Outcome& outcome : outcomes)
    for (const Verdict& verdict : outcome.verdicts) {
      std::map<std::string, const Row*> rows;
      for (const Row& row : verdict.rows) rows[row.expectation.metric] = &row;
      for (const auto& [metric, value] : verdict.metrics) rows.emplace(metric, nullptr);
      for (const auto& [metric, row] : rows) {
        ordered_json line = {{"case", outcome.asked.name}, {"runner", verdict.runner}, {"metric", metric}};
        const auto found = verdict.metrics.find(metric);
        line["found"] = found == verdict.metrics.end() ? ordered_json() : json_of(found->second);
        if (row) {
          const Expectation& asked = row->expectation;
          line["expected"] = asked.value ? json_of(*asked.value) : ordered_json();
          line["tolerance"] = asked.tolerance;
          if (row->error) line["error"] = *row->error;
          line["holds"] = row->holds;
        }
        lines += line.dump() + "\n";
      }
    }
  return lines;
}

}  // namespace tensegric_fit::regression
