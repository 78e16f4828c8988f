/// All that a command line of `fit` asks for, in memory: input files are read, nothing is written.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fit/command_line.hpp"
#include "fit/report.hpp"

namespace tensegric_fit::fit {

struct Computed {
  Settings settings;  ///< with tissue, posture and forces of the command line
  StageTimes times;
  Source source;
  Body body;
  std::optional<Fitting> fitting;  ///< none: measured only
  std::optional<Fit> fit;
  std::vector<geometry::FitWarning> warnings;

  nlohmann::ordered_json report() const;
};

/// Fills `computed`; a refusal leaves in it what was known of the source. `say` is called with what is begun.
/// \throw Refusal
void compute(
    const CommandLine& line, Computed& computed,
    const std::function<void(const std::string&)>& say = [](const std::string&) {});

}  // namespace tensegric_fit::fit
