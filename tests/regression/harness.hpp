/// A case through both runners.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison.hpp"
#include "recording.hpp"

namespace tensegric_fit::regression {

struct HarnessOptions {
  bool bag = true, replay = true;  ///< the runners
  int repeat = 1;                  ///< how often the bag runner runs a case; all must hash equal
  std::string folder;              ///< for bags and logs
};

struct Outcome {
  Case asked;
  Recording recording;  ///< of the bag runner, or of the replay where it alone was run
  std::vector<Verdict> verdicts;
  double seconds = 0;

  bool holds() const;
};

/// What ends with an exception is a fault of a verdict, not of the harness.
Outcome run_case(const Case& asked, const HarnessOptions& options);

}  // namespace tensegric_fit::regression
