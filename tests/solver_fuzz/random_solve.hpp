/// A solve that is drawn at random, and what is found when its result is measured apart from the solver.
#pragma once

#include <optional>

#include "../stability/stability_case.hpp"

namespace tensegric_fit::solver_fuzz {

/// A curved sheet of 60 to 2,000 triangles, half of them up to 180, under one to three lines at 0.3 to 1.3,
/// with 1 to 8 layers (fewer where it has many triangles). Same seed, same case.
stability::Case random_case(unsigned seed);

/// What came of it; `faults` is empty where all is well.
struct Finding {
  std::string status;  ///< of the solution, or the code of the refusal
  int iterations = 0;
  double residual = 0;      ///< as the solver has it
  double length_error = 0;  ///< largest relative difference of a line's length, from nodes and as reported
  double volume_error = 0;  ///< largest |dV / V|, from nodes
  double ms = 0;            ///< of the processor
  std::vector<std::string> faults;
};

/// The case's model, for any number of solves; null where it is refused, which `finding` then says: the cases
/// are sound, if hard.
std::optional<tensegric::Model> model_of(const stability::Case& drawn, Finding& finding);

/// Adds to `found` what must not be (README.md), from the solution's nodes.
void check(const stability::Case& drawn, const tensegric::Solution& solution, tensegric::SolverName solver,
           Finding& found);

/// `cap`, s of the processor, so that what else a machine does cuts no solve short. `most_iterations`: of
/// relaxation and adaptive; 0 their own.
Finding solve_and_check(const stability::Case& drawn, const tensegric::Model& model,
                        tensegric::SolverName solver, double cap, int most_iterations);

}  // namespace tensegric_fit::solver_fuzz
