/// A solve that is drawn at random, and what is found when its result is measured apart from the solver.
#pragma once

#include "../stability/stability_case.hpp"

namespace tensegric_fit::solver_fuzz {

/// A curved sheet of 60 to 2,000 triangles under one to three lines at 0.3 to 1.3, with 1 to 8 layers (fewer
/// where it has many triangles). Same seed, same case.
stability::Case random_case(unsigned seed);

/// What came of it; `faults` is empty where all is well.
struct Finding {
  std::string status;  ///< of the solution, or the code of the refusal
  int iterations = 0;
  double residual = 0;      ///< as the solver has it
  double length_error = 0;  ///< largest relative difference of a line's length, from nodes and as reported
  double volume_error = 0;  ///< largest |dV / V|, from nodes
  double ms = 0;
  std::vector<std::string> faults;
};

/// `cap`, s: time budget of the solve. `most_iterations`: of relaxation and adaptive; 0 their own.
Finding solve_and_check(const stability::Case& drawn, tensegric::SolverName solver, double cap,
                        int most_iterations);

}  // namespace tensegric_fit::solver_fuzz
