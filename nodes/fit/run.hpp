/// One run of `fit`: input files -> result files.
#pragma once

#include "fit/command_line.hpp"

namespace tensegric_fit::fit {

/// Exit code: 0 done (an infeasible request is done, and says so), 2 the results would overwrite an input, 3
/// input refused, 1 the results cannot be written.
int run(const CommandLine& line);

}  // namespace tensegric_fit::fit
