/// What came out beside what was expected.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "case.hpp"
#include "metrics.hpp"

namespace tensegric_fit::regression {

/// One metric of one run.
struct Row {
  Expectation expectation;
  std::optional<Value> found;
  std::optional<double> error;  ///< to the truth, where it is known
  bool holds = false;

  /// found - expected, where both are numbers.
  std::optional<double> difference() const;
};

struct Verdict {
  std::string runner;  ///< bag or replay
  std::vector<Row> rows;
  std::vector<std::string> faults;  ///< what is wrong beside metrics: a sentence each
  std::vector<std::string> notes;   ///< what may be wrong, or the machine's: they fail nothing
  Metrics metrics;                  ///< all, with the errors to the truth

  bool holds() const;
  int failures() const;
};

/// One row an expectation: a number holds within its tolerance, a word where it is the same; a metric that
/// was not found does not hold.
Verdict judge(const Case& asked, const std::string& runner, const Metrics& metrics);

/// Where two runs did not give the same payloads: a sentence a topic.
std::vector<std::string> differences(const std::map<std::string, std::string>& one,
                                     const std::map<std::string, std::string>& other);

}  // namespace tensegric_fit::regression
