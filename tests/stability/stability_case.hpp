/// Hard cases for the three solvers, and what may come of each: a status or a named refusal, finite numbers,
/// and exactness where a balance is claimed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/fibre.hpp"
#include "tensegric/solver.hpp"

namespace tensegric_fit::stability {

struct Case {
  std::string name;  ///< group/what is hard about it
  geometry::ControlMesh control;
  tensegric::Garment garment;
  std::vector<geometry::LaidLine> laid;  ///< of the garment, on the body
  tensegric::ModelOptions model;
  tensegric::SolverOptions solver;  ///< but for its name
  std::optional<tensegric::Solution> start;
  bool slow = false;    ///< for the long run only
  std::string refusal;  ///< code of the refusal that is due; empty: it must be solved; "?": either will do
};

/// Faulty, extreme and contradicting input on small meshes that are made here.
std::vector<Case> mesh_cases();
std::vector<Case> option_cases();
std::vector<Case> line_cases();

/// Every shipped garment on a virtual-booth body: each of its lines by itself, and all of them, asked for
/// each of `ratios`. `body`: firm, average or full.
std::vector<Case> garment_cases(const std::string& body, const std::vector<double>& ratios);

/// Every shipped template on a body of the virtual booth that is drawn at random. Same seed, same body.
std::vector<geometry::ControlMesh> template_meshes(std::uint64_t seed);

/// Largest net force at a free node of the undeformed model / mean tensile force: zero but for rounding.
double prestress_residual(const geometry::ControlMesh& control);

/// A small bust that starts from nodes thrown about at random. Same seed, same case.
Case random_start_case(unsigned seed);

/// How a case ended under a solver.
struct Ending {
  std::string status;  ///< of the solution, or the code of the refusal
  bool refused = false;
  int iterations = 0;
  double line_error = 0;    ///< largest L / l - 1 of the rigid lines
  double volume_error = 0;  ///< largest |dV / V|
  double residual = 0;
  double ms = 0;
  std::vector<std::string> faults;  ///< what must not be; empty where all is well
};

/// `most_iterations`: cap for relaxation and adaptive, 0 their own.
Ending run(const Case& hard, tensegric::SolverName solver, int most_iterations = 0);

}  // namespace tensegric_fit::stability
