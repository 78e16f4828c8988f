/// The process that fits one scan after the other for a batch.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tensegric_fit::batch {

/// A line of JSON from standard input, {"arguments": [options of fit]}, gives one on standard output:
/// {"status", "reason", "result", "cost"}, until input ends. `result` is the report of `fit` without what
/// differs from run to run (`cost`: seconds, memory) and with numbers of vertices in place of their lists.
/// More than `bytes` of address space is `out_of_memory`, and ends the process. Returns the exit code.
int work(std::size_t bytes);

}  // namespace tensegric_fit::batch
