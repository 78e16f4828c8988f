/// The command line of `fit` (launch/pages/programs.md).
#pragma once

#include <Eigen/Core>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fit/chain.hpp"
#include "mesh_files/reading.hpp"

namespace tensegric_fit::fit {

/// A neutral-length ratio for one line, or for every line where `line` is empty.
struct RatioRequest {
  std::string line;
  double ratio;
};

struct CommandLine {
  std::vector<std::string> scans;  ///< of one person, in one frame
  mesh_files::Asked asked;         ///< unit and axes of scans or mesh
  std::string mesh, garment, templates, tissue, control, customer, fixed, out = "fit_out";
  std::vector<RatioRequest> ratios;
  std::optional<tensegric::TensionLaw> band;
  geometry::Posture posture;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< as tensegric::force_of_share takes it
  std::vector<std::string> exports;                   ///< obj, glb, stl: files for makers' programs
  bool quiet = false;
  bool overlay = false;  ///< the registered body model in front.png and side.png
  Settings settings;

  /// A shape bent by gravity instead of a body with a garment (P1 Fig. 3).
  bool is_shape() const { return !fixed.empty(); }
};

/// Exit code where the program has nothing more to do (0 help, 2 usage), else none and `line` is filled. What
/// is wrong goes to `errors`.
std::optional<int> parse(int argc, const char* const* argv, CommandLine& line,
                         std::ostream& errors = std::cerr);
/// The same of the words behind the program's name.
std::optional<int> parse(const std::vector<std::string>& arguments, CommandLine& line, std::ostream& errors);

/// The garment with the ratios and the band of the command line. \throw Refusal unknown_line
tensegric::Garment adjusted(tensegric::Garment garment, const CommandLine& line);

}  // namespace tensegric_fit::fit
