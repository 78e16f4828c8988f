#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace tensegric_fit::regression {
namespace {

bool holds(const Row& row) {
  if (!row.found || !row.expectation.value) return false;
  const std::optional<double> difference = row.difference();
  return difference ? std::abs(*difference) <= row.expectation.tolerance
                    : *row.found == *row.expectation.value;
}

// landmark/NAME/x has the error of error/landmark/NAME.
std::optional<double> error_of(const std::string& metric, const Metrics& metrics) {
  const std::size_t axis = metric.rfind('/');
  for (const std::string& name : {metric, metric.substr(0, axis)}) {
    const auto error = metrics.find("error/" + name);
    if (error != metrics.end()) return std::get<double>(error->second);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> Row::difference() const {
  if (!found || !expectation.value) return std::nullopt;
  const double *is = std::get_if<double>(&*found), *wanted = std::get_if<double>(&*expectation.value);
  if (!is || !wanted) return std::nullopt;
  return *is - *wanted;
}

bool Verdict::holds() const {
  return faults.empty() && failures() == 0;
}

int Verdict::failures() const {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.holds; }));
}

Verdict judge(const Case& asked, const std::string& runner, const Metrics& metrics) {
  Verdict verdict;
  verdict.runner = runner;
  verdict.metrics = metrics;
  for (const Expectation& expectation : asked.expectations) {
    Row row;
    row.expectation = expectation;
    const auto found = metrics.find(expectation.metric);
    if (found != metrics.end()) row.found = found->second;
    row.error = error_of(expectation.metric, metrics);
    row.holds = regression::holds(row);
    verdict.rows.push_back(std::move(row));
  }
  const auto refusal = metrics.find("refusal");
  const bool is_asked_for = std::any_of(asked.expectations.begin(), asked.expectations.end(),
                                        [](const Expectation& e) { return e.metric == "refusal"; });
  if (!is_asked_for && refusal != metrics.end() && to_text(refusal->second) != "none")
    verdict.faults.push_back("it was refused: " + to_text(refusal->second));
  return verdict;
}

std::vector<std::string> differences(const std::map<std::string, std::string>& one,
                                     const std::map<std::string, std::string>& other) {
  std::set<std::string> topics;
  for (const auto& [topic, hash] : one) topics.insert(topic);
  for (const auto& [topic, hash] : other) topics.insert(topic);
  std::vector<std::string> sentences;
  for (const std::string& topic : topics) {
    const auto a = one.find(topic), b = other.find(topic);
    if (a == one.end() || b == other.end())
      sentences.push_back(topic + ": nothing came in one of the runs");
    else if (a->second != b->second)
      sentences.push_back(topic + ": other bits");
  }
  return sentences;
}

}  // namespace tensegric_fit::regression
