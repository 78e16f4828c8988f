// A sample of the hard cases: all that are quick. stability_table runs them all.
#include <gtest/gtest.h>

#include <limits>

#include "stability_case.hpp"
#include "tensegric/strut_relaxation.hpp"

namespace tensegric_fit::stability {
namespace {

using tensegric::SolverName;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
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

// Every template, every solver: what is not laced does not move.
TEST(Undeformed, StaysWhereItIsForAThousandCycles) {
  for (const geometry::ControlMesh& control : template_meshes(1)) {
    EXPECT_LE(prestress_residual(control), 1e-12);  // rounding: tensions are of the size 1
    const tensegric::Model model = tensegric::build_model(control, {});
    tensegric::Garment garment;
    for (const auto& line : control.lines) garment.lines.push_back({line.name, 1, {}, kNoLimit, {}, false});
    const tensegric::SolverOptions options;
    const tensegric::Problem problem = lay_garment(model, garment, options);
    const auto farthest = [&](const tensegric::Positions& x) {
      double far = 0;
      for (std::size_t i = 0; i < x.size(); ++i) far = std::max(far, (x[i] - problem.rest[i]).norm());
      return far;
    };
    for (bool adaptive : {false, true}) {
      tensegric::StrutRelaxation relaxation(problem, nullptr, adaptive);
      for (int i = 0; i < 1000; ++i) relaxation.cycle();
      EXPECT_LE(farthest(relaxation.state().x), 1e-9);
    }
    tensegric::Solution last = solve(model, garment, options);
    for (int i = 0; i < 1000; ++i) last = solve(model, garment, options, &last);
    EXPECT_LE(farthest(positions_of(last)), 1e-9);
  }
}

}  // namespace
}  // namespace tensegric_fit::stability
