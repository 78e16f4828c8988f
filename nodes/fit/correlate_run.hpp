/// One run of `correlate`: a fit and a worn scan -> result files.
#pragma once

#include "fit/correlate_line.hpp"

namespace tensegric_fit::fit {

/// Writes correlate.json, correlate.html, distance.png, silhouettes.png, distance.ply (the simulated body
/// coloured by distance) and distance.csv. Exit code: 0 done, 2 the results would overwrite an input, 3 input
/// refused, 1 the results cannot be written.
int run(const CorrelateLine& line);

}  // namespace tensegric_fit::fit
