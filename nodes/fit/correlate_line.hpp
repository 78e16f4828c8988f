/// The command line of `correlate`.
#pragma once

#include <optional>
#include <string>

#include "correlation/correlate.hpp"
#include "fit/chain.hpp"
#include "mesh_files/reading.hpp"

namespace tensegric_fit::fit {

struct CorrelateLine {
  std::string fit;          ///< folder that `fit --garment` wrote
  std::string worn, mesh;   ///< the second scan, or a body mesh in its place
  mesh_files::Asked asked;  ///< unit and axes of it
  std::string out = "correlate_out";
  correlation::Options options;
  bool quiet = false;
  Settings settings;
};

/// Exit code where the program has nothing more to do (0 help, 2 usage), else none and `line` is filled.
std::optional<int> parse(int argc, char** argv, CorrelateLine& line);

}  // namespace tensegric_fit::fit
