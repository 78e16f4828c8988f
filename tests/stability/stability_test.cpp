// A sample of the hard cases: all that are quick. stability_table runs them all.
#include <gtest/gtest.h>

#include "stability_case.hpp"

namespace tensegric_fit::stability {
namespace {

using tensegric::SolverName;

constexpr int kMostCycles =
    300;  // of the papers' solvers, which have no bound of their own on what is hard for them

void expect_no_faults(const Case& hard) {
  for (SolverName solver : {SolverName::equilibrium, SolverName::adaptive, SolverName::relaxation}) {
    const Ending ending = run(hard, solver, kMostCycles);
    for (const std::string& fault : ending.faults)
      ADD_FAILURE() << hard.name << ", " << to_string(solver) << ", " << ending.status << ": " << fault;
  }
}

void expect_no_faults(const std::vector<Case>& cases) {
  ASSERT_FALSE(cases.empty());
  for (const Case& hard : cases)
    if (!hard.slow) expect_no_faults(hard);
}

TEST(HardCases, Meshes) {
  expect_no_faults(mesh_cases());
}

TEST(HardCases, Options) {
  expect_no_faults(option_cases());
}

TEST(HardCases, Lines) {
  expect_no_faults(line_cases());
}

TEST(HardCases, GarmentsOnABody) {
  expect_no_faults(garment_cases("full", {0.9, 0.5}));
}

TEST(HardCases, RandomStarts) {
  for (unsigned seed = 1; seed <= 10; ++seed) expect_no_faults(random_start_case(seed));
}

}  // namespace
}  // namespace tensegric_fit::stability
