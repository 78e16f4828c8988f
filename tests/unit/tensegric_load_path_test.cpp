// The equilibrium solver on its way from rest, or from what was worn before, to the request: what it is
// stopped at, what it hands back, and what acts on the way.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "point_lists.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

class LoadPath : public testing::Test {
 protected:
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
};

// From "... at 50 % of the request ...".
double share_in(const std::string& note) {
  const std::size_t at = note.find(", at ");
  return at == std::string::npos ? NAN : std::strtod(note.c_str() + at + 5, nullptr) / 100;
}

TEST_F(LoadPath, TheNoteSaysHowFarItCame) {
  constexpr double kRatio = 0.70;
  const int whole = solve(model, chest(kRatio), {}).iterations;
  int on_the_way = 0;
  for (int most = 1; most < whole - 1; ++most) {
    SolverOptions options;
    options.max_iterations = most;
    const Solution s = solve(model, chest(kRatio), options);
    const double share = share_in(s.note);
    // Neutral lengths change evenly from rest to the request; the note has three digits.
    EXPECT_NEAR(s.lines[0].final / s.lines[0].initial, 1 - share * (1 - kRatio), 2e-4) << s.note;
    on_the_way += share > 0 && share < 1;
  }
  EXPECT_GT(on_the_way, 0);
}

TEST_F(LoadPath, AfterItWasCancelledItTakesNoMoreSteps) {
  const int whole = solve(model, chest(0.70), {}).iterations;
  for (int at = 1; at < whole; ++at) {
    int asked = 0, cancelled = 0;
    const Solution s =
        solve(model, chest(0.70), {}, nullptr, [&](const Iterate& iterate, const auto&, const auto&) {
          ++asked;
          cancelled += iterate.iteration == at;
          return iterate.iteration != at;
        });
    EXPECT_EQ(cancelled, 1);
    EXPECT_EQ(asked, at + 1) << at;  // the state at the start is one
    EXPECT_EQ(s.status, Status::capped);
  }
}

// A weight that hung on the tissue before hangs on it as it is, neither less nor twice.
TEST_F(LoadPath, AWarmStartUnderAWeightReachesTheSameBalance) {
  SolverOptions options;
  options.gravity = {0, 0, -0.01};
  const Solution before = solve(model, chest(0.95), options);
  ASSERT_EQ(before.status, Status::converged);
  for (const double ratio : {0.94, 0.80}) {  // in one step, and in several
    const Solution warm = solve(model, chest(ratio), options, &before),
                   cold = solve(model, chest(ratio), options);
    ASSERT_EQ(warm.status, Status::converged);
    ASSERT_EQ(cold.status, Status::converged);
    EXPECT_LT(warm.iterations, cold.iterations);
    EXPECT_LE(farthest(warm.outer, cold.outer), 1e-8);  // both are balanced to 1e-10 of the mean tension
  }
}

// An elastic band pulls by its law up to its limit, and no more, however far it is stretched.
TEST_F(LoadPath, AnElasticBandPullsItsLimitAndNoMore) {
  Garment garment = chest(0.90);
  garment.lines[0].law.kind = TensionLaw::Kind::stiffness;
  garment.lines[0].law.stiffness = 5;
  const double own = solve(model, garment, {}).lines[0].tension;
  garment.lines[0].tension_limit = own / 2;
  const Solution s = solve(model, garment, {});
  EXPECT_EQ(s.status, Status::infeasible);
  EXPECT_NEAR(s.lines[0].tension, own / 2, 1e-9);
  EXPECT_GT(5 * (s.lines[0].final / s.lines[0].neutral - 1), own / 2);  // what its law has for that length
  EXPECT_LE(s.residual, 1e-8);
  garment.lines[0].tension_limit = 2 * own;
  EXPECT_NEAR(solve(model, garment, {}).lines[0].tension, own, 1e-9);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
